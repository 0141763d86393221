// A sharp density as the set that it is.
#pragma once
#include "bounds/density_tree.hpp"

namespace deburr {

/// The set ρ > ½ of a density all of whose half-spaces are sharp, as a Boolean function of them. Where
/// sums and differences are legal these are unions and differences; elsewhere ρ passes 0 and 1 in whole
/// steps, and the function says which half-spaces then count twice: cube() − box + box is no union with
/// the box where that sticks out of the cube. A density that would become too large stays as it is.
DensityTree sharp_set(DensityTree density);

}  // namespace deburr
