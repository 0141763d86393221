// Vertices that a mesh does not need to stay within a tolerance of the surface: edge collapses onto one of the edge's
// own vertices, so that all vertices stay where they were found, on the surface.
//
// Flat faces stay exactly flat, creases and borders of materials stay lines of edges, and the mesh stays closed and
// outward. What is held against the tolerance: the middle and the edges' middles of every triangle that a collapse
// changes, and the vertex that goes.
#pragma once
#include "polygonizer/mesh/cancel.hpp"
#include "polygonizer/mesh/facet_judge.hpp"

namespace deburr {

/// Collapses edges of a closed mesh while its distance from the surface stays below `tolerance`. Returns how many
/// vertices went. Throws Stopped.
std::size_t decimate(Mesh& mesh, std::vector<Origin>& origins, const FacetJudge& judge, double tolerance,
                     StopFlag stop = nullptr);

}  // namespace deburr
