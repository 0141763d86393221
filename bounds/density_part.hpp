// Parts of a flat density tree.
#pragma once
#include <vector>

#include "bounds/density_tree.hpp"

namespace deburr {

/// The part of a tree below one of its nodes, as a tree of its own.
DensityTree part_below(const DensityTree& tree, int root);

/// The nodes whose sum, or union, the tree is: the root alone where it is neither.
std::vector<int> summands(const DensityTree& tree);

}  // namespace deburr
