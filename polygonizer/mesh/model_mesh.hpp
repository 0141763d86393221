// The mesh of a solid that is a closed mesh already.
#pragma once
#include "bounds/closed_mesh.hpp"
#include "bounds/solid_tree.hpp"
#include "polygonizer/mesh/mesh.hpp"

namespace deburr {

/// The closed mesh that the solid is, without rounding and without operators; or null.
std::shared_ptr<const ClosedMesh> closed_mesh_of(const SolidTree& solid);

/// Its triangles as they are, each with the normal of its face; `polygons` are the faces.
Mesh mesh_of(const ClosedMesh& model, int material);

}  // namespace deburr
