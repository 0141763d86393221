// Sharp densities with round parts as solids: a sharp density is a set, whose round parts are quadrics and tori.
#pragma once
#include "bounds/solid_tree.hpp"

namespace deburr {

/// Whether the tree has round parts and none of its half-spaces has a filter radius > 0.
bool is_sharp_round(const DensityTree& tree);

/// Appends leaves and nodes that make up the sharp density to `to` and returns the index of their root node. A subtree
/// without round parts is one leaf.
int add_sharp_round(const DensityTree& density, int material, int line, SolidTree& to);

}  // namespace deburr
