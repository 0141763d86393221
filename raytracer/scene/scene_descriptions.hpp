// Descriptions of the values that a scene's functions make, for print() and tostring().
#pragma once
#include <string>

#include "raytracer/scene/scene_functions.hpp"

namespace deburr {

/// A text such as "density of 6 half-spaces, [0, 1]³, radius 0.1" or "plastic{ color = {0.7, 0.1, 0.1}, roughness =
/// 0.2, ior = 1.5 }", without addresses and the same on every run.
std::string description(const SceneObject& object);

/// The number of half-spaces, or of their equivalents in fields, that description() must process.
double work_to_describe(const SceneObject& object);

/// The function of the scene language that makes this kind of material, such as "matte".
const char* name_of(Material::Kind kind);

}  // namespace deburr
