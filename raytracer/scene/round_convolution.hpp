// The true convolution of densities with round parts [Lobb eq. 1]. It has no closed form for cylinders, cones and tori,
// but for meshes: so the density is polygonized more sharply and finely than the ball can resolve, and the mesh is
// convolved [docs/design.md, Closed meshes].
#pragma once
#include <stdexcept>

#include "bounds/solid.hpp"

namespace deburr {

/// How far the surface may be from that of the exact convolution, in radii of the ball.
inline constexpr double round_convolution_tolerance = 0.01;

/// The density cannot be polygonized, because it is unbounded or would take too many cells.
struct NoRoundConvolution : std::invalid_argument {
    using std::invalid_argument::invalid_argument;
};

/// The density, read as a Boolean function, convolved with a ball of this radius > 0. Throws NoRoundConvolution and
/// BadRoundPart.
Solid convolved_round(double radius, const Density& density, int line);

}  // namespace deburr
