// Refines a mesh to a tolerance: triangles that are too far from the surface are split at edges, by vertices on the
// surface [Triage §8, refinement by curvature].
//
// Splitting edges costs no more than the triangles that it makes, whereas cutting cells again would polygonize
// everything around them again. Flat faces keep their triangles except for new vertices on their borders.
//
// Not promised: that splits suffice. Where two sheets of the surface are nearer to each other than a triangle is to
// either, they may not; such triangles are returned.
#pragma once
#include <span>

#include "polygonizer/mesh/cancel.hpp"
#include "polygonizer/mesh/facet_judge.hpp"
#include "polygonizer/mesh/good_facets.hpp"

namespace deburr {

/// Splits and flips edges of a closed mesh until points all over its curved triangles are within the distance
/// `tolerance` of the surface. Returns the triangles, by number in the refined mesh, for which nothing helped. Facets
/// in `good` count as near. `patches` of the mesh follow the changes. Throws Cancelled.
std::vector<int> refine(Mesh& mesh, std::vector<Origin>& origins, const FacetJudge& judge, double tolerance,
                        CancelFlag cancel = nullptr, const GoodFacets* good = nullptr, Patches* patches = nullptr);

/// Refines only these triangles and those that their splits make; the others stay as they are.
std::vector<int> refine(Mesh& mesh, std::vector<Origin>& origins, std::span<const int> triangles,
                        const FacetJudge& judge, double tolerance, CancelFlag cancel = nullptr,
                        Patches* patches = nullptr);

}  // namespace deburr
