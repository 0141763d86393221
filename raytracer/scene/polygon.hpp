// Simple polygons as Boolean functions of their sides' half-planes.
//
// Every simple polygon has a formula of "and" and "or" that names the half-plane of each side once and no others
// [Peterson 1984; Dobkin, Guibas, Hershberger & Snoeyink 1993]. As a Boolean density it has no walls inside, so no
// seams, and is rounded as it stands. Where no side of the polygon is one of its hull, nothing bounds it for certain:
// so it is held by the box around it, moved out of the way of rounding.
#pragma once
#include <vector>

#include "bounds/density.hpp"

namespace deburr {

/// Across which axis a polygon lies, and along which it is raised: x has points {y, z}, y {x, z} and z {x, y}.
enum class PrismAxis { x, y, z };

/// The polygon, either way round, raised from low to high along the axis. Several points on one side, and the first
/// one again at the end, do no harm. Throws std::runtime_error where the polygon has no area or meets itself.
/// Convex ones are products, as the papers have them; others are Boolean densities.
Density prism(const std::vector<Vec2>& polygon, double low, double high, PrismAxis axis = PrismAxis::y);
/// The same without ends and without bounds, to be taken out of another: a Boolean function whatever its shape.
Density raised_polygon(const std::vector<Vec2>& polygon, PrismAxis axis);

}  // namespace deburr
