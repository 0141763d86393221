// The true convolution of densities with round parts [Lobb eq. 1]. Of cylinders, cones and tori it has no closed form,
// of meshes it has: the density is polygonized sharper and finer than the ball can tell, and that mesh is convolved
// [docs/design.md, Closed meshes].
#pragma once
#include <stdexcept>

#include "bounds/solid.hpp"

namespace deburr {

/// How far the surface may lie from that of the exact convolution, in radii of the ball.
inline constexpr double round_convolution_tolerance = 0.01;

/// Thrown where a density cannot be polygonized: it has no bounds, or would take too many cells.
struct NoRoundConvolution : std::invalid_argument {
    using std::invalid_argument::invalid_argument;
};

/// The density, read as a Boolean function, convolved with a ball of this radius > 0. Throws NoRoundConvolution, and
/// BadRoundPart.
Solid convolved_round(double radius, const Density& density, int line);

}  // namespace deburr
