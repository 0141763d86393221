// What print() and tostring() say of the values that a scene's functions make.
#pragma once
#include <string>

#include "raytracer/scene/scene_functions.hpp"

namespace deburr {

/// As in "density of 6 half-spaces, [0, 1]³, radius 0.1" or "plastic{ color = {0.7, 0.1, 0.1}, roughness = 0.2, ior =
/// 1.5 }": no addresses, and the same on every run.
std::string description(const SceneObject& object);

/// Half-spaces, and their like in fields, that have to be laid out to describe it.
double work_to_describe(const SceneObject& object);

/// The material's kind as the function of the scene language that makes it: "matte".
const char* name_of(Material::Kind kind);

}  // namespace deburr
