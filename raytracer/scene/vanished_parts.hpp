// Warnings about parts that rounding makes vanish, and about solids that are empty.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "raytracer/scene/scene.hpp"

namespace deburr {

/// The warnings, a line each.
struct VanishedParts {
    /// For each part that vanishes by rounding, such as `lid.lua:7: solid 2: a part in [0, 1] x [0, 0.1] x [0, 1]
    /// vanishes at radius 0.2; up to 0.178 it stays`, and for each model with walls that are too thin.
    std::vector<std::string> rounded_away;
    /// For each other solid that is empty.
    std::vector<std::string> empty;
};

/// The parts of sums and unions that have a volume before they are rounded or convolved and none after, and the solids
/// that are empty. `nodes` limits the work, in evaluated nodes. What cannot be proved is not reported.
VanishedParts vanished_parts(const Scene& scene, std::int64_t nodes = 20'000'000);

/// Whether every solid is proved to be empty; returns soon if one is not. `nodes` limits the work.
bool nothing_is_left(const Scene& scene, std::int64_t nodes = 20'000'000);

}  // namespace deburr
