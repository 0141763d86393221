// Finds where a mesh crosses itself.
#pragma once
#include <utility>

#include "polygonizer/mesh/cancel.hpp"
#include "polygonizer/mesh/triangle_tree.hpp"

namespace deburr {

/// The length by which triangles of a mesh in this box may reach into each other where parts touch: vertices lie in
/// facets only up to the rounding of their computation.
double touching_slack(const Box& box);

/// The pairs of triangles whose interiors meet, each with the lesser number first, in order. Triangles that reach into
/// each other by no more than touching_slack() do not count. `tree` is the mesh's; `looked_at`, if given, becomes the
/// number of pairs whose boxes meet. Throws Cancelled.
std::vector<std::pair<int, int>> crossing_triangles(const Mesh& mesh, const TriangleTree& tree,
                                                    CancelFlag cancel = nullptr, std::size_t* looked_at = nullptr);

/// Appends both triangles of every crossing pair to `triangles` and returns the number of pairs. Throws Cancelled.
std::size_t add_crossing(const Mesh& mesh, std::vector<int>& triangles, CancelFlag cancel = nullptr);

}  // namespace deburr
