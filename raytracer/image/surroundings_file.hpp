// Pictures that surround a scene, from files of any format that is written.
#pragma once
#include "raytracer/scene/scene.hpp"

namespace deburr {

/// Reads the pictures that the scene's backgrounds name. Throws UsageError if one cannot be read, or holds no light
/// that is finite and not negative.
void load_surroundings(Scene& scene);

}  // namespace deburr
