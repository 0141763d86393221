// The box of an intersection of half-spaces, by linear programs along the axes (Seidel 1991).
#pragma once
#include <vector>

#include "bounds/csg_bounds.hpp"

namespace deburr {

/// Least box around { x : n·x ≤ offset for all planes }, but for a relative 10⁻⁹; sides at ±infinity
/// where it is unbounded; empty where there is no such x.
Box polyhedron_box(const std::vector<BoundPlane>& planes);

/// An intersection that is still gathering: of planes, and of a box that stands for all else.
struct GatheredBox {
    Box rest = Box::everything();
    std::vector<BoundPlane> planes;

    Box box() const { return planes.empty() || rest.empty() ? rest : intersection(rest, polyhedron_box(planes)); }
};

GatheredBox intersect(GatheredBox a, GatheredBox b);
/// The hull; planes end here.
GatheredBox unite(const GatheredBox& a, const GatheredBox& b);

}  // namespace deburr
