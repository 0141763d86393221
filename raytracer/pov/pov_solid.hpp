// Solids as objects of POV-Ray's: rounded densities as isosurfaces, the primary CSG tree [Lobb §2.2] as
// CSG of them.
#pragma once
#include <functional>
#include <string>

#include "bounds/solid_tree.hpp"

namespace deburr {

struct PovSurface {
    bool sharp = false;             // every radius 0: CSG of planes and boxes, and no isosurface
    bool min_max = false;           // the profile is clamped by min and max instead of by cases: a slower field
    double max_gradient = 0;        // 0: what is proved of each density
    double accuracy = 0;            // 0: a ten-thousandth of each density's least radius
    Box limit = Box::everything();  // what is infinite ends here; finite
};

struct PovSolid {
    std::string text;  // empty: there is nothing of the solid
    bool cut = false;  // it was infinite, and ends at the limit now
};

/// `material` names the modifiers of a leaf's surface. Where sharp and rounded half-spaces meet in one
/// density it is divided along the sharp ones, ρ = H·ρ(H = 1) + (1 − H)·ρ(H = 0). A density of sharp
/// ones is read as plain CSG, which it is where it is legal. Throws UnsupportedError, with the line, for
/// what has no formula of a sensible length (PovField) or would be divided too often.
PovSolid pov_solid(const SolidTree& solid, const PovSurface& surface, const std::function<std::string(int)>& material);

}  // namespace deburr
