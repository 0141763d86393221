// Warnings about pictures that will show nothing, or not what was meant.
#pragma once
#include <string>
#include <vector>

#include "raytracer/scene/scene.hpp"

namespace deburr {

/// Whether nothing in the scene emits light: no light, no background, no material.
bool is_unlit(const Scene& scene);

/// A line for each problem: no light reaches anything; a light or the camera is inside a solid; the camera sees none of
/// the bounded solids in a picture with this ratio of width to height; its angle of view is hardly meant.
std::vector<std::string> view_warnings(const Scene& scene, double aspect);

}  // namespace deburr
