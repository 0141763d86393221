// OBJ, and the MTL that tells its materials' colours.
#pragma once
#include "polygonizer/mesh/export.hpp"

namespace deburr {

/// Names `notes.material_file`, if that is not empty, as the file where its materials are.
std::string encode_obj(const Mesh& mesh, const MeshNotes& notes);

/// The materials that the mesh has, each by its diffuse reflectivity, linear as the scene says it.
std::string encode_mtl(const Mesh& mesh, const MeshNotes& notes);

}  // namespace deburr
