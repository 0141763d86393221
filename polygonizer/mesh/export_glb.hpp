// Writes binary glTF 2.0: one node and mesh per solid, with a primitive for each of its materials.
#pragma once
#include "polygonizer/mesh/export.hpp"

namespace deburr {

/// The bytes of a GLB file. Throws std::length_error if they do not fit the format's 32 bits.
std::string encode_glb(const Mesh& mesh, const MeshNotes& notes);

}  // namespace deburr
