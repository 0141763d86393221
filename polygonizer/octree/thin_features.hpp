// Parts of a free form that are thinner than the octree's cells: corners miss what passes between them.
//
// They are seen by a look through the solid, or over a gap, from a point of the mesh, and to the
// surface from the middle of a leaf without points.
#pragma once
#include "polygonizer/octree/octree_linking.hpp"
#include "polygonizer/octree/point_mesh.hpp"

namespace deburr {

/// Cuts leaves where the surface has a sheet that no point of the mesh stands for, to cells of about its
/// thickness; false if there is none, or cells are as small as may be. Point k of the mesh is loop k's.
bool split_unseen(CellTree& tree, const Linking& linking, const PointMesh& mesh);

}  // namespace deburr
