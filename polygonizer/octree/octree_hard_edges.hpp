// Hard edges: edges where faces meet at an angle, which the mesh has to follow [Vyatkin §3.4].
//
// Most of their points are found in cells (octree_points). What remains are edges of the mesh that pass from one face
// to another beside the hard edge: such an edge is divided on the hard edge, or an end that is near moves there. Then
// hard edges are divided to the wanted length:
//
//   s(P)   the wanted length of edges at P: that of a cell, less where the hard edge turns at P
//   S      the point that divides an edge PQ that is too long, S = (s(P)·Q + s(Q)·P)/(s(P) + s(Q)),
//          moved to where the two surfaces meet
//
// Both kinds of division make two triangles of each of the two triangles at the edge.
#pragma once
#include "polygonizer/octree/octree_cells.hpp"
#include "polygonizer/octree/point_mesh.hpp"

namespace deburr {

/// Moves points to hard edges and adds points there; returns how many. `hard_cosine` is the cosine of the least angle
/// between faces at which their edge is hard.
std::size_t follow_hard_edges(PointMesh& mesh, const CellTree& tree, double hard_cosine);

/// Divides hard edges that are too long; returns how many.
std::size_t divide_hard_edges(PointMesh& mesh, const CellTree& tree, double hard_cosine);

}  // namespace deburr
