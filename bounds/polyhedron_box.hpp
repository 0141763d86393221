// The bounding box of an intersection of half-spaces, by linear programs along the axes (Seidel 1991).
#pragma once
#include <vector>

#include "bounds/csg_bounds.hpp"

namespace deburr {

/// The least box around { x : n·x ≤ offset for all planes }, up to a relative 10⁻⁹, by which it may be larger. Sides
/// are at ±infinity where the set is unbounded; the box is empty if there is no such x.
Box polyhedron_box(const std::vector<BoundPlane>& planes);

/// An intersection that is being gathered: of planes, and of the box `rest` around everything else.
struct GatheredBox {
    Box rest = Box::everything();
    std::vector<BoundPlane> planes;

    Box box() const { return planes.empty() || rest.empty() ? rest : intersection(rest, polyhedron_box(planes)); }
};

/// The intersection of both, with the planes of both.
GatheredBox intersect(GatheredBox a, GatheredBox b);
/// The union of both, as the hull of their boxes; no planes are left.
GatheredBox unite(const GatheredBox& a, const GatheredBox& b);

}  // namespace deburr
