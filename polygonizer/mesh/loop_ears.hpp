// Triangulates loops that no triangulation of the plane has as its edges, because they cross.
#pragma once
#include <array>
#include <vector>

#include "bounds/vec.hpp"

namespace deburr {

/// Triangulates a disc whose border is made of the loops and of bridges, one from each loop to the nearest corner of
/// the loops before it. Ears are cut off, the best shaped first, even if other vertices lie in them. plane_points[i][k]
/// is loops[i][k] in the plane. Triangles are triples of the loops' vertices.
std::vector<std::array<int, 3>> loop_ears(const std::vector<std::vector<int>>& loops,
                                          const std::vector<std::vector<Vec2>>& plane_points);

}  // namespace deburr
