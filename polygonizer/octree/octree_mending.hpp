// Mends an octree's mesh once its cells are cut: facets are turned, unfolded and decimated.
#pragma once
#include "polygonizer/mesh/cancel.hpp"
#include "polygonizer/mesh/facet_judge.hpp"
#include "polygonizer/mesh/mended_mesh.hpp"
#include "polygonizer/mesh/work_progress.hpp"

namespace deburr {

/// The mesh, mended as far as is possible without smaller cells, and its remaining faults. Throws Cancelled.
MendedMesh mended(Mesh mesh, std::vector<Origin> origins, const FacetJudge& judge, double tolerance, CancelFlag cancel);

/// The mesh decimated within the tolerance. Around faults that this causes the mesh stays as it was. Throws Cancelled.
MendedMesh thinned_out(const MendedMesh& fine, const SolidTree& solid, double tolerance, CancelFlag cancel,
                       WorkProgress* progress);

/// Throws OpenMeshError, with counts and a place, unless every edge is between two triangles that run through it in
/// opposite directions and every point has one fan.
void throw_unless_closed(const Mesh& mesh);

}  // namespace deburr
