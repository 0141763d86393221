// The files that `deburr mesh` writes.
#pragma once
#include <string>
#include <vector>

#include "polygonizer/mesh/export.hpp"

namespace deburr {

/// A file of a mesh, and what must be written with it.
struct MeshOutput {
    std::string path;
    MeshFormat format;
    std::string material_path = {};  // the MTL beside an OBJ; "": none
};

/// The files that `paths` (-o) ask for. Throws UsageError for a name whose ending is no format.
std::vector<MeshOutput> mesh_outputs(const std::vector<std::string>& paths);

/// The names of all of them.
std::vector<std::string> files_of(const std::vector<MeshOutput>& outputs);

/// Throws WorkError; the files of one output appear together or not at all.
void write_mesh(const MeshOutput& output, const Mesh& mesh, MeshNotes notes);

}  // namespace deburr
