// A test of when a cell needs no further cut: when it is simple [docs/design.md, Meshing].
//
// A cell is simple for a density if in some direction ρ provably only falls. Then every line along that direction meets
// the surface once at most, so the cell holds one sheet of it, a graph; and no part of the surface lies wholly within
// the cell, because such a part would have a point with ∇ρ = 0 inside.
//
// Not promised: that every cell that holds a graph is found to be simple. Cells that are small against the filter are
// found, except around critical points of ρ.
#pragma once
#include <vector>

#include "bounds/local_density.hpp"

namespace deburr {

/// Whether the convex cell with these corners is provably simple. Vertices within `tolerance` of a plane count as on
/// it.
bool is_simple(const LocalDensity& density, const std::vector<Vec3>& corners, double tolerance);

}  // namespace deburr
