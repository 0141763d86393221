// Triangulates small polygons without holes, in the plane.
#pragma once
#include <array>
#include <vector>

#include "bounds/vec.hpp"

namespace deburr {

/// The corner, 0 or 1, from which a diagonal cuts the quadrilateral into two counter-clockwise triangles. If both
/// diagonals do, the one is taken that makes the best shaped triangle; −1 if neither does.
int quadrilateral_diagonal(const std::array<Vec2, 4>& corners);

/// Triangles of a simple polygon as triples of its corners' indices, none of them clockwise. Corners may lie on
/// straight sides. Takes time cubic in the number of corners.
std::vector<std::array<int, 3>> small_polygon(const std::vector<Vec2>& corners);

/// Removes the triangles around a vertex; `ring`, which is empty before, becomes the cycle of their outer edges'
/// vertices. Returns false, with a useless ring, if these are not a single cycle.
bool take_ring(std::vector<std::array<int, 3>>& triangles, int vertex, std::vector<int>& ring);

}  // namespace deburr
