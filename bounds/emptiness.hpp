// Whether a set has any point at all in a box.
//
// Boxes are halved until one's middle is in the set, or the range of ρ over every one of them excludes the set.
//
// Not promised: an answer. Sets that are nearly empty, and empty ones that nearly are not, take more boxes than any.
#pragma once
#include <cstdint>

#include "bounds/solid_tree.hpp"

namespace deburr {

enum class Emptiness { empty, not_empty, unknown };

/// Looks at so many tree nodes at most, and counts `nodes` down. The box is finite.
Emptiness emptiness(const SolidTree& tree, const Box& box, std::int64_t& nodes);
/// As above, of the set ρ > ½.
Emptiness emptiness(const DensityTree& tree, const Box& box, std::int64_t& nodes);

}  // namespace deburr
