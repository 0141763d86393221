// A mesh within a tolerance of the surface, with as few triangles as edge collapses (edge_collapses.hpp) leave.
//
// A large mesh is thinned out in blocks, side by side, and then where they meet. The blocks depend on the mesh alone,
// so that the result does not depend on the number of threads.
#pragma once
#include <span>

#include "polygonizer/mesh/cancel.hpp"
#include "polygonizer/mesh/facet_judge.hpp"
#include "polygonizer/mesh/work_progress.hpp"

namespace deburr {

struct DecimationOptions {
    std::span<const Box> dense = {};  // vertices in them stay
    std::size_t enough = 0;           // no fewer triangles than this are wanted; then all is one thread's
    CancelFlag cancel = nullptr;
    WorkProgress* progress = nullptr;  // advanced by a phase
};

/// Collapses edges of a closed mesh while its distance from the surface stays below `tolerance`. Returns how many
/// vertices went. Throws Cancelled.
std::size_t decimate(Mesh& mesh, std::vector<Origin>& origins, const FacetJudge& judge, double tolerance,
                     const DecimationOptions& options = {});

}  // namespace deburr
