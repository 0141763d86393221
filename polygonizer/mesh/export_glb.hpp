// Binary glTF 2.0: one node and mesh a solid, with a primitive for each of its materials.
#pragma once
#include "polygonizer/mesh/export.hpp"

namespace deburr {

/// Throws std::length_error if the mesh does not fit the format's 32 bits.
std::string encode_glb(const Mesh& mesh, const MeshNotes& notes);

}  // namespace deburr
