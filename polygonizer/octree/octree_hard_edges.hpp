// Hard edges: where faces meet at an angle, and the mesh has to follow [Vyatkin §3.4].
//
// Most of their points are found cell by cell (octree_points). What is left are edges of the mesh
// that pass from one face to another beside them: such an edge is divided where it does, or an end
// that is near is moved there. Then hard edges are divided to the wanted length:
//
//   s(P)   the wanted length of edges at P: that of a cell, less where the hard edge turns at P
//   S      the point that divides an edge PQ that is too long, S = (s(P)·Q + s(Q)·P)/(s(P) + s(Q)),
//          taken to where the two surfaces meet
//
// At either, each of the two triangles at the edge becomes two.
#pragma once
#include "polygonizer/octree/octree_cells.hpp"
#include "polygonizer/octree/point_mesh.hpp"

namespace deburr {

/// How many points were moved to hard edges, and how many put there.
std::size_t follow_hard_edges(PointMesh& mesh, const CellTree& tree, double hard_cosine);

/// How many edges were divided.
std::size_t divide_hard_edges(PointMesh& mesh, const CellTree& tree, double hard_cosine);

}  // namespace deburr
