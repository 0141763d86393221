// Densities of mixed radii, with sharp half-spaces moved up into the primary CSG tree.
//
// A sharp half-space S in a rounded density makes it jump, as a clipping plane does [Triage §6.1,
// the punch pin]. Over S and over its complement the density is continuous, so
//
//     {ρ > ½} = (S ∩ {ρ with S = 1 > ½}) ∪ ({ρ with S = 0 > ½} \ S),
//
// and every leaf of the result is rounded throughout or sharp throughout. S may be round, too: then it is a leaf of its
// own, a field.
#pragma once
#include "bounds/solid_tree.hpp"

namespace deburr {

/// The same solid. Not promised for a density that mixes so many that the result would pass a few
/// hundred leaves: that one stays as it is.
SolidTree separate_sharp(const SolidTree& solid);

}  // namespace deburr
