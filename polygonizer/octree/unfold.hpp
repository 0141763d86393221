// Facets that are folded over onto the one beyond an edge.
//
// A facet whose corners are three points of one seam, between a plane and a curved surface, lies in the plane whichever
// of the two it was made for. Where the solid is a thin wedge there, it lies on the plane's facet beyond its chord of
// the seam, and faces the other way. The plane's facets are to go as far as the seam, not as far as the chord: the
// chord becomes the other diagonal of the two.
#pragma once
#include <utility>
#include <vector>

#include "polygonizer/mesh/facet_judge.hpp"

namespace deburr {

/// Unfolds those of the pairs of triangles that have an edge in common and that this helps; returns how many.
std::size_t unfold(Mesh& mesh, std::vector<Origin>& origins, const FacetJudge& judge,
                   const std::vector<std::pair<int, int>>& pairs);

}  // namespace deburr
