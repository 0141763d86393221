// Mends a closed mesh: facets without area or facing inward, and vertices off the surface. It uses edge flips,
// collapses and splits, which keep the mesh a closed 2-manifold; new vertices are roots on the surfaces that meet
// there.
//
// Facets are wrong where the isosurface grazes a cell's face or edge, so that roots lie close together; where two
// outlines in a plane, each a chain of chords, cross; and where two surfaces are nearer to each other than the mesh is
// to either. The first need an edge less, the others more edges.
#pragma once
#include "polygonizer/mesh/facet_judge.hpp"
#include "polygonizer/mesh/good_facets.hpp"

namespace deburr {

/// What a repair has done, and what is left to do.
struct RepairStatistics {
    /// Numbers of edges flipped, collapsed and split, and of vertices moved onto the surface.
    std::size_t flips = 0, collapses = 0, splits = 0, moves = 0;
    std::vector<int> left;     // triangles for which nothing helped, or with a vertex that is still off the surface
    std::vector<int> changed;  // triangles that are new or have a vertex that moved
    std::vector<int> numbers;  // for each given triangle its number now, or −1 if it is gone or changed
    double farthest = 0;  // greatest distance of a triangle's middle from the surface afterwards, `good` ones excluded
};

/// Mends the mesh; `origins`, one for each triangle, is updated. Only the last resort makes facets that are farther
/// than `tolerance` from the surface where none was. Without `may_split` no edge is split: where surfaces cross at
/// almost no angle, halves of bad facets are bad facets again. Facets in `good`, if given, are taken to be good.
/// `patches` of the mesh follow the changes.
RepairStatistics repair(Mesh& mesh, std::vector<Origin>& origins, const FacetJudge& judge, double tolerance = infinity,
                        bool may_split = true, const GoodFacets* good = nullptr, Patches* patches = nullptr);

}  // namespace deburr
