// Solids as POV-Ray objects: rounded densities as isosurfaces, and CSG of them for the primary CSG tree [Lobb §2.2].
#pragma once
#include <functional>
#include <string>

#include "bounds/solid_tree.hpp"

namespace deburr {

/// How surfaces are written.
struct PovSurface {
    bool sharp = false;             // every radius is 0: CSG of planes and boxes, no isosurfaces
    bool min_max = false;           // clamp the profile by min and max instead of by cases: slower
    double max_gradient = 0;        // of isosurfaces; 0: what is proven for each density
    double accuracy = 0;            // scene length; 0: 10⁻⁴ of each density's least radius
    Box limit = Box::everything();  // infinite solids are cut off here; must be finite
};

/// A solid in POV-Ray's language.
struct PovSolid {
    std::string text;  // empty: the solid is empty
    bool cut = false;  // whether it was infinite and was cut off at the limit
};

/// The solid as an object. `material` returns the modifiers for a material's index. A density with both sharp and
/// rounded half-spaces is divided along the sharp ones, ρ = H·ρ(H = 1) + (1 − H)·ρ(H = 0). A density with sharp
/// half-spaces only is read as plain CSG, which it is where it is legal. Throws UnsupportedError, with the line, for
/// densities whose formula would be too long (PovField) or that would be divided too often, and for fields and
/// convolutions without a formula.
PovSolid pov_solid(const SolidTree& solid, const PovSurface& surface, const std::function<std::string(int)>& material);

}  // namespace deburr
