// Vertices that a mesh does not need: on a straight border of a flat face, where two cells' parts of a
// rounded edge meet it.
#pragma once
#include "polygonizer/mesh/facet_judge.hpp"

namespace deburr {

/// Collapses them; no triangle gets farther from the surface than `farthest`. Returns how many went.
std::size_t simplify_borders(Mesh& mesh, std::vector<Origin>& origins, const FacetJudge& judge, double farthest);

}  // namespace deburr
