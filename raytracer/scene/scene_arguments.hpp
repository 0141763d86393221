// What the functions of a scene ask of their arguments: a density, something with an inside, a list.
//
// Each need_… returns what the argument is, or throws BadValue, whose message says what was expected at `location` and
// what the scene gave.
#pragma once
#include <string>
#include <vector>

#include "raytracer/scene/scene_functions.hpp"

namespace deburr {

/// The density that `value` is, or null.
const Density* as_density(const LuaValue& value);

/// Whether `value` has an inside: a density, a solid, a quadric or a model.
bool is_set(const LuaValue& value);

/// The density, solid, quadric or model that `value` is.
const SceneObject& need_set(const LuaValue& value, const char* location);

/// As need_set, or a perturbation, which can be moved, too.
const SceneObject& need_movable(const LuaValue& value, const char* location);

/// The density that `value` is. `what` is expected, in the words of the message.
const Density& need_density(const LuaValue& value, const char* location, const char* what = "a density");

/// The items of a list of at most `most`. `of_what`: their name in the plural, as "points".
const std::vector<LuaValue>& need_list(const LuaValue& value, const std::string& location, const char* of_what,
                                       std::size_t most);

/// "location[1]": the item at `index`, counted from 0, of the list at `location`.
std::string item(const std::string& location, std::size_t index);

}  // namespace deburr
