// Decimation by edge collapses: a vertex that the mesh does not need to stay within a tolerance of the surface moves
// onto a neighbour, or both ends of an edge become one vertex on the surface near its middle. So all vertices stay on
// the surface.
//
// Flat faces stay exactly flat, creases and borders of materials stay lines of edges, and the mesh stays closed and
// faces outward. Two things are held to the tolerance: thirteen points of every triangle that a collapse changes, all
// over its inside and its edges, and the removed vertices.
#pragma once
#include <span>

#include "polygonizer/mesh/cancel.hpp"
#include "polygonizer/mesh/facet_judge.hpp"
#include "polygonizer/mesh/work_progress.hpp"

namespace deburr {

/// What a run of collapses must keep, and how it reports. Null pointers and empty spans are allowed.
struct CollapseOptions {
    std::span<const Box> dense = {};  // vertices in these boxes stay
    // By vertex: those with facets outside of this mesh stay, and nothing moves onto them. Empty: there are none.
    std::span<const char> border = {};
    // By vertex: first only vertices of facets at these are tried, later also those near a change. Empty: all are
    // tried.
    std::span<const char> around = {};
    std::size_t enough = 0;  // the run ends at this number of triangles
    CancelFlag cancel = nullptr;
    WorkProgress* progress = nullptr;
    double share_of_phase = 0;  // the fraction of the progress's phase that the run reports
};

/// Collapses edges of a mesh, which is closed except for its border, while it stays within the distance `tolerance` of
/// the surface. `origins`, one for each triangle, is updated. Returns the number of vertices removed. `vertices` and
/// `normals` get, for each one that is left, its old number. Throws Cancelled.
std::size_t collapse_edges(Mesh& mesh, std::vector<Origin>& origins, const FacetJudge& judge, double tolerance,
                           const CollapseOptions& options, std::vector<int>* vertices = nullptr,
                           std::vector<int>* normals = nullptr);

}  // namespace deburr
