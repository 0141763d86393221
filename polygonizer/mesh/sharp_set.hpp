// Sharp densities as Boolean functions.
#pragma once
#include "bounds/density_tree.hpp"

namespace deburr {

/// The set ρ > ½ of a density all of whose half-spaces are sharp, as a Boolean function of them. Where sums and
/// differences are legal these become unions and differences. Elsewhere ρ takes whole numbers below 0 and above 1, and
/// the function says where half-spaces count twice: cube() − box + box is no union with the box where that sticks out
/// of the cube. A density whose function would be too large is returned unchanged.
DensityTree sharp_set(DensityTree density);

}  // namespace deburr
