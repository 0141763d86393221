// Warnings about densities that leave [0, 1].
#pragma once
#include <string>
#include <vector>

#include "raytracer/scene/scene.hpp"

namespace deburr {

/// A line for each place in the scene whose sum or difference is illegal (bounds/legality.hpp), such as `plate.lua:7:
/// sum: expected a density of at most 1, got 1.93 at (0.5, 0.5, 0.9); its parts overlap: use |`. `boxes` limits the
/// number of boxes examined for an operator.
std::vector<std::string> illegal_densities(const Scene& scene, int boxes = 20'000);

}  // namespace deburr
