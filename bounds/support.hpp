// Bounding boxes of the parts of a tree, to prune distant parts quickly. Interval arithmetic alone does
// not see that a tilted block is far away, for none of its planes need be.
#pragma once
#include "bounds/density_tree.hpp"

namespace deburr {

/// Sets `support` of the bounded parts: sums, differences, disjunctions and whole intersections that
/// are certainly 0 outside some box smaller than space.
void find_supports(DensityTree& tree);

/// Half-spaces of the same radius that hold a round part between them, and touch it where it reaches farthest along the
/// coordinate axes; none of what has no such planes.
std::vector<HalfSpace> touching_planes(const HalfSpace& part);

}  // namespace deburr
