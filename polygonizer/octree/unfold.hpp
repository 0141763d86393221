// Unfolds facets that are folded onto the facet across an edge.
//
// A facet whose corners are three points of one seam between a plane and a curved surface lies in the plane, whichever
// of the two it was made for. If the solid is a thin wedge there, the facet lies on the plane's facet across its chord
// of the seam, and faces the other way. The plane's facets should reach to the seam, not to the chord: the chord
// becomes the other diagonal of the two.
#pragma once
#include <utility>
#include <vector>

#include "polygonizer/mesh/facet_judge.hpp"

namespace deburr {

/// Unfolds pairs of triangles with a common edge where this helps; returns how many. `origins` is updated.
std::size_t unfold(Mesh& mesh, std::vector<Origin>& origins, const FacetJudge& judge,
                   const std::vector<std::pair<int, int>>& pairs);

}  // namespace deburr
