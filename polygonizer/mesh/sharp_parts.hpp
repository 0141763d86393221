// Moves sharp half-spaces of densities with mixed radii up into the primary CSG tree.
//
// A sharp half-space S in a rounded density makes the density jump, as a clipping plane does [Triage §6.1, the punch
// pin]. Over S and over its complement the density is continuous, so
//
//     {ρ > ½} = (S ∩ {ρ with S = 1 > ½}) ∪ ({ρ with S = 0 > ½} \ S),
//
// and every leaf of the result is rounded throughout or sharp throughout. A round S becomes a leaf of its own, a field.
#pragma once
#include "bounds/solid_tree.hpp"

namespace deburr {

/// Returns the same solid as a tree none of whose leaves is both sharp and rounded. A density that would become more
/// than 256 leaves is the exception: it stays as it is.
SolidTree separate_sharp(const SolidTree& solid);

}  // namespace deburr
