// Triangles of loops that no triangulation of the plane has as its edges.
#pragma once
#include <array>
#include <vector>

#include "bounds/vec.hpp"

namespace deburr {

/// A disc whose rim are the loops, joined by bridges from each to the nearest corner of those before. Corners are cut
/// off, the best shaped first, whatever else lies there. `plane_points`: of the loops' vertices.
std::vector<std::array<int, 3>> loop_ears(const std::vector<std::vector<int>>& loops,
                                          const std::vector<std::vector<Vec2>>& plane_points);

}  // namespace deburr
