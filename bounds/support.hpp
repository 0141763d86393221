// Where a density is not 0: boxes around the parts of a tree, for pruning far parts at a glance.
// Interval arithmetic alone does not see that a tilted block is far away: no plane of it need be.
#pragma once
#include "bounds/density_tree.hpp"

namespace deburr {

/// Sets `support` of the bounded parts: sums, differences, disjunctions and whole intersections that
/// are certainly 0 outside some box smaller than space.
void find_supports(DensityTree& tree);

}  // namespace deburr
