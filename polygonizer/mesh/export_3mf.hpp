// Writes 3MF [core specification 1.3]: a ZIP archive with the model as XML.
#pragma once
#include "polygonizer/mesh/export.hpp"

namespace deburr {

/// The bytes of a 3MF file. Throws std::length_error if the model is 4 GiB of text or more.
std::string encode_3mf(const Mesh& mesh, const MeshNotes& notes);

}  // namespace deburr
