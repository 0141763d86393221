// The last repair of a mesh by triage, and its verdict.
#pragma once
#include "polygonizer/mesh/cancel.hpp"
#include "polygonizer/mesh/facet_judge.hpp"
#include "polygonizer/mesh/mended_mesh.hpp"

namespace deburr {

/// Repairs the mesh, drops shells of it that are wrong, and looks for crossing facets and, with a finite tolerance, for
/// those farther than that. What is wrong is sorted. `may_split`: repairs may put vertices in. Throws Cancelled.
MendedMesh mend(Mesh mesh, std::vector<Origin> origins, const FacetJudge& judge, double tolerance, bool may_split,
                CancelFlag cancel);

}  // namespace deburr
