// Where a mesh crosses itself.
#pragma once
#include <utility>

#include "polygonizer/mesh/cancel.hpp"
#include "polygonizer/mesh/triangle_tree.hpp"

namespace deburr {

/// Length by which triangles of a mesh in this box reach into each other where parts touch: vertices lie in facets up
/// to the rounding of what computed them.
double touching_slack(const Box& box);

/// Pairs of triangles whose insides meet, the lesser number first, in order. Those that reach into each other by no
/// more than rounding, where parts touch, do not count. `tree` is the mesh's; `looked_at`, if given, becomes the number
/// of pairs whose boxes meet. Throws Cancelled.
std::vector<std::pair<int, int>> crossing_triangles(const Mesh& mesh, const TriangleTree& tree,
                                                    CancelFlag cancel = nullptr, std::size_t* looked_at = nullptr);

/// Appends both triangles of every pair that crosses to `triangles`; returns the number of pairs. Throws Cancelled.
std::size_t add_crossing(const Mesh& mesh, std::vector<int>& triangles, CancelFlag cancel = nullptr);

}  // namespace deburr
