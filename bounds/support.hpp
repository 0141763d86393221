// Bounding boxes of the parts of a tree, with which distant parts are pruned quickly. Interval arithmetic alone does
// not see that a tilted block is far away, for none of its planes need be.
#pragma once
#include "bounds/density_tree.hpp"

namespace deburr {

/// Sets `support` of the tree's bounded nodes: round parts, sums, differences, disjunctions and whole intersections
/// that are certainly 0 outside of a box smaller than space. The boxes are appended to tree.supports.
void find_supports(DensityTree& tree);

/// Half-spaces with the round part's filter radius whose intersection holds the part, and which touch it where it
/// reaches farthest along the coordinate axes. The list is empty if the part has no such planes, as one that is the
/// complement of a bounded set.
std::vector<HalfSpace> touching_planes(const HalfSpace& part);

}  // namespace deburr
