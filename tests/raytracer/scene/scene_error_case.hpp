// Scenes with errors, and the messages expected for them.
#pragma once
#include <map>
#include <string>

#include "catch.hpp"
#include "raytracer/scene/scene_reader.hpp"

namespace deburr {

/// The reader's message for the scene "s.lua" with this text under these limits; "no error" if it is accepted.
inline std::string error_within(const std::string& text, const SandboxLimits& limits,
                                const std::map<std::string, std::string>& defines = {}) {
    try {
        read_scene_text(text, "s.lua", defines, limits);
    } catch (const SceneError& error) {
        return error.what();
    }
    return "no error";
}

/// The same under limits that a scene of a few lines keeps.
inline std::string error_of(const std::string& text, const std::map<std::string, std::string>& defines = {}) {
    return error_within(text, {std::size_t(64) << 20, 20'000'000, 20.0}, defines);
}

struct ErrorCase {
    const char *text, *error;
};

inline void check_error(const ErrorCase& c) {
    CAPTURE(c.text);
    CHECK(error_of(c.text) == c.error);
}

}  // namespace deburr
