// Which cells of a subdivision to halve, so that what is polygonized in them comes near enough to the
// surface [Triage §8, refinement by curvature].
#pragma once
#include "polygonizer/mesh/facets.hpp"
#include "polygonizer/triage/subspace.hpp"

namespace deburr {

struct Cut {
    int cell;
    double error;  // how much it is needed
    Plane plane;
};

/// Cells whose part of the mesh leans too far from the surface's normal. One cut for each.
std::vector<Cut> cells_to_halve(const Mesh& mesh, const std::vector<Origin>& origins, const Subdivision& subdivision);

/// The cells of these triangles. One cut for each.
std::vector<Cut> cells_to_halve(const Mesh& mesh, const std::vector<Origin>& origins, const std::vector<int>& triangles,
                                const Subdivision& subdivision);

/// Cells whose polygons in a subspace, all of it or a part, lean too far, or are farther than `tolerance` from the
/// surface. One cut for each.
std::vector<Cut> cells_to_halve(const Subspace& subspace, double tolerance);

/// The cells that triangles came from, and those of their neighbours.
std::vector<Cut> cells_around(const Mesh& mesh, const std::vector<Origin>& origins, const std::vector<int>& triangles,
                              const Subdivision& subdivision);

}  // namespace deburr
