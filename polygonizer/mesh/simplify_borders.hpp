// Removes vertices that a mesh does not need: those on a straight border of a flat face, where two cells' parts of a
// rounded edge meet it.
#pragma once
#include "polygonizer/mesh/facet_judge.hpp"

namespace deburr {

/// Collapses such vertices; no triangle gets farther from the surface than `farthest`. `origins`, one for each
/// triangle, is updated. Returns the number of vertices removed.
std::size_t simplify_borders(Mesh& mesh, std::vector<Origin>& origins, const FacetJudge& judge, double farthest);

}  // namespace deburr
