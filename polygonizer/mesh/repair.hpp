// What is left to mend in a closed mesh: facets without area or facing inward, and vertices beside
// the surface. It is done by edge flips, collapses and splits that keep it a closed 2-manifold; new
// vertices are roots on the surfaces that meet there.
//
// Facets come out wrong where the isosurface grazes a cell's face or edge, so that roots lie close
// together; where two outlines in a plane, each a chain of chords, cross; and where two surfaces are
// nearer to each other than the mesh is to either. The first needs an edge less, the others more.
#pragma once
#include "polygonizer/mesh/facet_judge.hpp"
#include "polygonizer/mesh/good_facets.hpp"

namespace deburr {

struct RepairStatistics {
    std::size_t flips = 0, collapses = 0, splits = 0, moves = 0;
    std::vector<int> left;     // triangles for which nothing helped
    std::vector<int> changed;  // triangles that came, or have a vertex that was moved
    std::vector<int> numbers;  // of the triangles that were given: as they are now, or −1 where they went or changed
    double farthest = 0;       // distance of a triangle's middle from the surface, in the end
};

/// Only the last resort makes facets that are farther from the surface than the tolerance, where none was.
/// Without splits the mesh stays as fine as it is: where surfaces cross at almost no angle, halves of what is
/// wrong are wrong again. `good` facets need not be mended; how far they are from the surface is not told. `patches` of
/// the mesh follow.
RepairStatistics repair(Mesh& mesh, std::vector<Origin>& origins, const FacetJudge& judge, double tolerance = infinity,
                        bool may_split = true, const GoodFacets* good = nullptr, Patches* patches = nullptr);

}  // namespace deburr
