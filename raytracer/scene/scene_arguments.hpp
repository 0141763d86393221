// Checks of the arguments of a scene's functions: a density, a set, a list.
//
// Each need_… returns what the argument is, or throws BadValue with what was expected at `location` and what the scene
// gave.
#pragma once
#include <string>
#include <vector>

#include "raytracer/scene/scene_functions.hpp"

namespace deburr {

/// The density in `value`; null if it is none.
const Density* as_density(const LuaValue& value);

/// Whether `value` is a set of points: a density, a solid, a quadric or a model.
bool is_set(const LuaValue& value);

/// The density, solid, quadric or model in `value`.
const SceneObject& need_set(const LuaValue& value, const char* location);

/// As need_set(), but allows a perturbation, which can be transformed, too.
const SceneObject& need_movable(const LuaValue& value, const char* location);

/// The density in `value`; `what` names the expected value in the message.
const Density& need_density(const LuaValue& value, const char* location, const char* what = "a density");

/// The items of a list of at most `most`; `of_what` is their name in the plural, such as "points".
const std::vector<LuaValue>& need_list(const LuaValue& value, const std::string& location, const char* of_what,
                                       std::size_t most);

/// The location of a list's item: "location[1]" for index 0.
std::string item(const std::string& location, std::size_t index);

}  // namespace deburr
