// Vertices that a mesh does not need to stay within a tolerance of the surface go by edge collapses: onto one of the
// edge's own vertices, or both onto the surface at its middle. So all vertices stay on the surface.
//
// Flat faces stay exactly flat, creases and borders of materials stay lines of edges, and the mesh stays closed and
// outward. What is held against the tolerance: thirteen points of every triangle that a collapse changes, spread over
// its inside and its edges, and the vertices that go.
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
