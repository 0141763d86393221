// Meshes of solids that are closed meshes already.
#pragma once
#include "bounds/closed_mesh.hpp"
#include "bounds/solid_tree.hpp"
#include "polygonizer/mesh/mesh.hpp"

namespace deburr {

/// The closed mesh that the solid consists of, if there is one, without rounding and without operators; else null.
std::shared_ptr<const ClosedMesh> closed_mesh_of(const SolidTree& solid);

/// The model's triangles unchanged, each with the normal of its face; Mesh::polygons counts the faces.
Mesh mesh_of(const ClosedMesh& model, int material);

}  // namespace deburr
