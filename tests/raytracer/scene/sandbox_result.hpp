// Lua run in the sandbox of scenes.
#pragma once
#include <string>
#include <variant>

#include "raytracer/scene/lua_sandbox.hpp"
#include "raytracer/scene/lua_values.hpp"

namespace deburr {

/// The first result of "s.lua" with this text, as text, or the error's message.
inline std::string result_of(const std::string& text, const SandboxLimits& limits = {}) {
    try {
        Sandbox sandbox(limits);
        const LuaValue value = read_value(sandbox.run(text, "s.lua"), 1, "result");
        const auto* string = std::get_if<std::string>(&value);
        return string ? *string : described(value);
    } catch (const SceneError& error) {
        return error.what();
    }
}

}  // namespace deburr
