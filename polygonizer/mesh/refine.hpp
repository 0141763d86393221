// A mesh brought within a tolerance of its surface: triangles that are too far from it are split at edges, by vertices
// on the surface [Triage §8, refinement by curvature].
//
// Splitting edges of the mesh costs no more than the triangles that it makes, where cutting cells anew would
// polygonize all that lies around them again. Flat faces keep their triangles but for new vertices on their rims.
//
// Not promised: that splits lead there. Where two sheets are nearer to each other than a triangle is to either, they
// may not; the triangles concerned are told.
#pragma once
#include <span>

#include "polygonizer/mesh/cancel.hpp"
#include "polygonizer/mesh/facet_judge.hpp"
#include "polygonizer/mesh/good_facets.hpp"

namespace deburr {

/// Splits edges of a closed mesh until points all over its curved triangles are within `tolerance` of the surface.
/// Returns the triangles, in the order of the refined mesh, for which no split or flip led there. `good` are near;
/// `patches` of the mesh follow. Throws Cancelled.
std::vector<int> refine(Mesh& mesh, std::vector<Origin>& origins, const FacetJudge& judge, double tolerance,
                        CancelFlag cancel = nullptr, const GoodFacets* good = nullptr, Patches* patches = nullptr);

/// The same for some of the triangles, and for what their splits touch; the others stay as they are.
std::vector<int> refine(Mesh& mesh, std::vector<Origin>& origins, std::span<const int> triangles,
                        const FacetJudge& judge, double tolerance, CancelFlag cancel = nullptr,
                        Patches* patches = nullptr);

}  // namespace deburr
