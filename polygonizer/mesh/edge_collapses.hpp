// Vertices that a mesh does not need to stay within a tolerance of the surface go by edge collapses: onto one of the
// edge's own vertices, or both onto the surface at its middle. So all vertices stay on the surface.
//
// Flat faces stay exactly flat, creases and borders of materials stay lines of edges, and the mesh stays closed and
// outward. What is held against the tolerance: thirteen points of every triangle that a collapse changes, spread over
// its inside and its edges, and the vertices that go.
#pragma once
#include <span>

#include "polygonizer/mesh/cancel.hpp"
#include "polygonizer/mesh/facet_judge.hpp"
#include "polygonizer/mesh/work_progress.hpp"

namespace deburr {

struct CollapseOptions {
    std::span<const Box> dense = {};  // vertices in them stay
    // By vertex: those that have facets which are not in the mesh stay, and nothing moves onto them. Empty: none.
    std::span<const char> border = {};
    // By vertex: only vertices of facets at these are looked at, until something has changed. Empty: all are.
    std::span<const char> around = {};
    std::size_t enough = 0;  // no fewer triangles than this are wanted
    CancelFlag cancel = nullptr;
    WorkProgress* progress = nullptr;
    double share_of_phase = 0;  // of the progress, told by and by
};

/// Collapses edges of a mesh, closed but for its border, while its distance from the surface stays below `tolerance`.
/// Returns how many vertices went. Of those that are left, `vertices` and `normals` get the numbers that they had.
/// Throws Cancelled.
std::size_t collapse_edges(Mesh& mesh, std::vector<Origin>& origins, const FacetJudge& judge, double tolerance,
                           const CollapseOptions& options, std::vector<int>* vertices = nullptr,
                           std::vector<int>* normals = nullptr);

}  // namespace deburr
