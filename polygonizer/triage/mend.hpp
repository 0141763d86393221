// Repairs a mesh by triage for the last time, and judges it.
#pragma once
#include "polygonizer/mesh/cancel.hpp"
#include "polygonizer/mesh/facet_judge.hpp"
#include "polygonizer/mesh/mended_mesh.hpp"

namespace deburr {

/// Repairs the mesh, drops wrong shells, and finds facets that cross and, with a finite tolerance, facets that are
/// farther from the surface than that. MendedMesh::wrong is sorted. `may_split` allows the repair to add vertices.
/// Throws Cancelled.
MendedMesh mend(Mesh mesh, std::vector<Origin> origins, const FacetJudge& judge, double tolerance, bool may_split,
                CancelFlag cancel);

}  // namespace deburr
