// Polygons of few corners and without holes, in the plane.
#pragma once
#include <array>
#include <vector>

#include "bounds/vec.hpp"

namespace deburr {

/// The corner, 0 or 1, from which a diagonal cuts the quadrilateral into two triangles that are counter-clockwise,
/// one of them as well shaped as can be; −1 if neither does.
int quadrilateral_diagonal(const std::array<Vec2, 4>& corners);

/// Triangles of a simple polygon, by its corners' numbers, in a time of the third power of how many there are.
/// Corners may lie on straight sides. No triangle is wrong way round.
std::vector<std::array<int, 3>> small_polygon(const std::vector<Vec2>& corners);

/// Takes the triangles around a vertex away; `ring` becomes their outer edges, one after the other. False, and the
/// ring is of no use, if these are not one ring.
bool take_ring(std::vector<std::array<int, 3>>& triangles, int vertex, std::vector<int>& ring);

}  // namespace deburr
