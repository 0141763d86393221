// Scenes read from text in memory.
#pragma once
#include <map>
#include <string>

#include "raytracer/scene/scene_reader.hpp"

namespace deburr {

/// The scene "s.lua" with this text.
inline Scene scene_of(const std::string& text, const std::map<std::string, std::string>& defines = {}) {
    return read_scene_text(text, "s.lua", defines);
}

}  // namespace deburr
