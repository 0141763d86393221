// What a user is told of solids that rounding, or an operator, leaves nothing of.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "raytracer/scene/scene.hpp"

namespace deburr {

struct VanishedParts {
    /// A line for each part that rounding leaves nothing of, such as `lid.lua:7: solid 2: a part in [0, 1] x [0, 0.1] x
    /// [0, 1] vanishes at radius 0.2; up to 0.178 it stays`, and one for each model with walls that are too thin.
    std::vector<std::string> rounded_away;
    /// A line for each other solid that is empty.
    std::vector<std::string> empty;
};

/// The parts of sums and unions that have a volume before they are rounded, or convolved, and none then, and the solids
/// that are empty. `nodes` is how long to look. What cannot be proved is not told.
VanishedParts vanished_parts(const Scene& scene, std::int64_t nodes = 20'000'000);

/// Whether every solid is proved to be empty: soon known where one is not.
bool nothing_is_left(const Scene& scene, std::int64_t nodes = 20'000'000);

}  // namespace deburr
