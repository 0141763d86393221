// Triangles of a flat polygon with holes, by ear clipping.
#pragma once
#include <array>
#include <vector>

#include "bounds/vec.hpp"

namespace deburr {

/// `loops`: vertex numbers; the outer one counter-clockwise seen against `normal`, holes clockwise,
/// in any order. Every edge of a loop is an edge of exactly one triangle. Vertices on a straight
/// side are fine. A polygon that is not quite flat, or touches itself, still gets triangles that
/// meet its edges.
std::vector<std::array<int, 3>> triangles_of(const std::vector<std::vector<int>>& loops,
                                             const std::vector<Vec3>& positions, Vec3 normal);

}  // namespace deburr
