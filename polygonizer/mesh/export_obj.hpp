// Writes OBJ, and the MTL file with its materials' colours.
#pragma once
#include "polygonizer/mesh/export.hpp"

namespace deburr {

/// The bytes of an OBJ file. It names `notes.material_file`, if that is not empty, as the file of its materials.
std::string encode_obj(const Mesh& mesh, const MeshNotes& notes);

/// The bytes of an MTL file with the materials that occur in the mesh. Each has its linear diffuse reflectance.
std::string encode_mtl(const Mesh& mesh, const MeshNotes& notes);

}  // namespace deburr
