// Simple polygons as Boolean functions of their sides' half-planes.
//
// Every simple polygon has a formula of "and" and "or" that names each side's half-plane exactly once and no others
// [Peterson 1984; Dobkin, Guibas, Hershberger & Snoeyink 1993]. As a Boolean density it has no internal walls, and so
// no seams, and can be rounded as it is. Where no side of the polygon is a side of its convex hull, its bounding box
// could not be proved, so the formula is intersected with the box, enlarged to be out of the way of rounding.
#pragma once
#include <vector>

#include "bounds/density.hpp"

namespace deburr {

/// The axis along which a polygon is extruded; its points are {y, z} for x, {x, z} for y and {x, y} for z.
enum class PrismAxis { x, y, z };

/// The polygon, in either orientation, extruded from low to high along the axis. Collinear points, and the first point
/// repeated at the end, are allowed. Throws std::runtime_error if the polygon has no area or intersects itself. Convex
/// polygons become products, as in the papers; others are Boolean densities.
Density prism(const std::vector<Vec2>& polygon, double low, double high, PrismAxis axis = PrismAxis::y);
/// The polygon extruded infinitely in both directions, to be subtracted from another: always a Boolean density.
Density raised_polygon(const std::vector<Vec2>& polygon, PrismAxis axis);

}  // namespace deburr
