// Triangulates loops that no triangulation of the plane has as its edges, because they cross.
#pragma once
#include <array>
#include <vector>

#include "bounds/vec.hpp"

namespace deburr {

/// A disc whose border are the loops, joined by bridges from each loop to the nearest corner of those before. Ears are
/// cut off, the best shaped first, even if other vertices lie in them. plane_points[i][k] is loops[i][k] in the plane.
/// Triangles are triples of the loops' vertices.
std::vector<std::array<int, 3>> loop_ears(const std::vector<std::vector<int>>& loops,
                                          const std::vector<std::vector<Vec2>>& plane_points);

}  // namespace deburr
