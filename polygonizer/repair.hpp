// What is left to mend in a closed mesh: facets without area or facing inward, and vertices beside
// the surface. It is done by edge flips, collapses and splits that keep it a closed 2-manifold; new
// vertices are roots on the surfaces that meet there.
//
// Facets come out wrong where the isosurface grazes a cell's face or edge, so that roots lie close
// together; where two outlines in a plane, each a chain of chords, cross; and where two surfaces are
// nearer to each other than the mesh is to either. The first needs an edge less, the others more.
#pragma once
#include "polygonizer/facets.hpp"
#include "polygonizer/leaf_surfaces.hpp"

namespace deburr {

struct RepairStatistics {
    std::size_t flips = 0, collapses = 0, splits = 0, moves = 0;
    std::vector<int> left;  // triangles for which nothing helped
};

/// `solid` is what the mesh approximates.
RepairStatistics repair(Mesh& mesh, std::vector<Origin>& origins, const SolidTree& solid);

/// Collapses vertices on a straight border of a flat face that the face does not need: where two
/// cells' parts of a rounded edge meet it. Triangles stay as near to the surface as the worst of
/// them was. Returns how many went.
std::size_t thin_borders(Mesh& mesh, std::vector<Origin>& origins, const SolidTree& solid);

}  // namespace deburr
