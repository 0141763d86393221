// Decimates a mesh: as few triangles as edge collapses (edge_collapses.hpp) leave within a tolerance of the surface.
//
// A large mesh is decimated in blocks, concurrently, and then where these meet. Blocks depend on the mesh alone, so the
// result does not depend on the number of threads.
#pragma once
#include <span>

#include "polygonizer/mesh/cancel.hpp"
#include "polygonizer/mesh/facet_judge.hpp"
#include "polygonizer/mesh/work_progress.hpp"

namespace deburr {

/// What decimation must keep, and how it reports. Null pointers and empty spans are allowed.
struct DecimationOptions {
    std::span<const Box> dense = {};  // vertices in these boxes stay
    std::size_t enough = 0;  // decimation ends at this number of triangles; unless it is 0, a single thread does all
    CancelFlag cancel = nullptr;
    WorkProgress* progress = nullptr;  // advanced by one phase
};

/// Collapses edges of a closed mesh while it stays within the distance `tolerance` of the surface. `origins`, one for
/// each triangle, is updated. Returns the number of vertices removed. Throws Cancelled.
std::size_t decimate(Mesh& mesh, std::vector<Origin>& origins, const FacetJudge& judge, double tolerance,
                     const DecimationOptions& options = {});

}  // namespace deburr
