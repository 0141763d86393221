// Finds parts of a free form that are thinner than the octree's cells, so that corners miss them.
//
// They are found by probing through the solid, or across a gap, from a point of the mesh, and from the middle of a leaf
// without points to the surface.
#pragma once
#include "polygonizer/octree/octree_linking.hpp"
#include "polygonizer/octree/point_mesh.hpp"

namespace deburr {

/// Cuts leaves where the surface has a sheet for which the mesh has no point, to cells of about its thickness. False if
/// there is none, or cells are as small as possible. Point k of the mesh belongs to loop k.
bool split_unseen(CellTree& tree, const Linking& linking, const PointMesh& mesh);

}  // namespace deburr
