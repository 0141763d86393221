// Slivers taken out of a closed mesh, by edge flips and edge collapses that keep it a 2-manifold.
//
// Where the isosurface grazes a cell's face or edge, roots lie so close together that a triangle
// has no area, or leans against the surface. Halving the cell does not help, for the sliver stays;
// one edge less does. Vertices stay where they are, on the surface.
#pragma once
#include "polygonizer/mesh.hpp"
#include "polygonizer/surface_offset.hpp"

namespace deburr {

struct RepairStatistics {
    std::size_t flips = 0, collapses = 0, left = 0;  // left: slivers for which nothing helped
};

/// `solid` is what the mesh approximates.
RepairStatistics repair(Mesh& mesh, const OffsetField& solid);

/// Collapses vertices on a straight border of a flat face that the face does not need: where two
/// cells' parts of a rounded edge meet it. Triangles stay as near to the surface as the worst of
/// them was. Returns how many went.
std::size_t thin_borders(Mesh& mesh, const OffsetField& solid);

}  // namespace deburr
