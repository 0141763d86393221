// Whether a solid has any point in a box.
//
// Boxes are halved until the middle of one is in the set, or the range of ρ over each of them excludes the set.
//
// Not promised: an answer. Sets that are nearly empty, or barely not empty, may take more boxes than the effort allows.
#pragma once
#include <cstdint>

#include "bounds/solid_tree.hpp"

namespace deburr {

enum class Emptiness { empty, not_empty, unknown };

/// Whether the solid has a point in the finite box. At most `nodes` tree nodes are looked at, and `nodes` is counted
/// down; `unknown` if they do not suffice.
Emptiness emptiness(const SolidTree& tree, const Box& box, std::int64_t& nodes);
/// Whether the set ρ > ½ has a point in the finite box, with the same effort.
Emptiness emptiness(const DensityTree& tree, const Box& box, std::int64_t& nodes);

}  // namespace deburr
