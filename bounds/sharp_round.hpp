// Sharp densities with round parts, as solids: a sharp density is a set, and its round parts are quadrics and tori.
#pragma once
#include "bounds/solid_tree.hpp"

namespace deburr {

/// Whether the tree has round parts, and none of its parts is rounded.
bool is_sharp_round(const DensityTree& tree);

/// Adds leaves and nodes that make up the sharp density to the tree; the number of its node. Half-spaces that round
/// parts are not between stay together.
int add_sharp_round(const DensityTree& density, int material, int line, SolidTree& to);

}  // namespace deburr
