// What becomes of an octree's mesh once its cells are cut: facets are turned, unfolded and thinned out.
#pragma once
#include "polygonizer/mesh/cancel.hpp"
#include "polygonizer/mesh/facet_judge.hpp"
#include "polygonizer/mesh/mended_mesh.hpp"
#include "polygonizer/mesh/work_progress.hpp"

namespace deburr {

/// The mesh, as far as it can be mended without smaller cells.
MendedMesh mended(Mesh mesh, std::vector<Origin> origins, const FacetJudge& judge, double tolerance, CancelFlag cancel);

/// The mesh with fewer triangles, within the tolerance; around what that makes wrong it stays as it was.
MendedMesh thinned_out(const MendedMesh& fine, const SolidTree& solid, double tolerance, CancelFlag cancel,
                       WorkProgress* progress);

/// Throws OpenMeshError, with counts and a place, unless each edge is between two triangles that run through it in
/// turn and each point has one fan.
void throw_unless_closed(const Mesh& mesh);

}  // namespace deburr
