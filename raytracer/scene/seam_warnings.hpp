// Warnings about round parts that run on smoothly into other surfaces.
#pragma once
#include <string>
#include <vector>

#include "raytracer/scene/scene.hpp"

namespace deburr {

/// A line for each rounded density that has tangent seams (bounds/tangent_seams.hpp), such as `hook.lua:7: a round part
/// runs on smoothly into another surface and bulges there by 0.028, 0.28 of the radius, at (2, 0.5, 0); and in 3 more
/// places`.
std::vector<std::string> seam_warnings(const Scene& scene);

}  // namespace deburr
