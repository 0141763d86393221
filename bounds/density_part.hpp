// Subtrees of a flat density tree.
#pragma once
#include <vector>

#include "bounds/density_tree.hpp"

namespace deburr {

/// The subtree below node `root` as a tree of its own, with the supports of its nodes.
DensityTree part_below(const DensityTree& tree, int root);

/// The nodes whose sum or union the whole tree is, from left to right: the root alone if it is neither a sum nor a
/// disjunction.
std::vector<int> summands(const DensityTree& tree);

}  // namespace deburr
