// Selects the cells of a subdivision to halve, so that what is polygonized in them comes near enough to the surface
// [Triage §8, refinement by curvature].
#pragma once
#include "polygonizer/mesh/facets.hpp"
#include "polygonizer/triage/subspace.hpp"

namespace deburr {

/// A cell and the plane that halves it.
struct Cut {
    int cell;
    double error;  // the greater, the more urgent
    Plane plane;
};

/// Cells whose triangles lean too far from the surface; one cut for each.
std::vector<Cut> cells_to_halve(const Mesh& mesh, const std::vector<Origin>& origins, const Subdivision& subdivision);

/// The cells that these triangles came from; one cut for each.
std::vector<Cut> cells_to_halve(const Mesh& mesh, const std::vector<Origin>& origins, const std::vector<int>& triangles,
                                const Subdivision& subdivision);

/// Cells of the subdivision whose polygons in a subspace lean too far or are farther than `tolerance` from the surface;
/// one cut for each.
std::vector<Cut> cells_to_halve(const Subspace& subspace, double tolerance);

/// The cells that these triangles and those at their edges came from; one cut for each.
std::vector<Cut> cells_around(const Mesh& mesh, const std::vector<Origin>& origins, const std::vector<int>& triangles,
                              const Subdivision& subdivision);

}  // namespace deburr
