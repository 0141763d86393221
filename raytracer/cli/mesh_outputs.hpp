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

/// Which way is up in the files. Scenes are y-up.
enum class UpAxis { y, z };

/// --up. Throws UsageError.
UpAxis parse_up(const std::string& text);

/// Throws WorkError; the files of one output appear together or not at all. GLB is y-up whatever is asked, for glTF is.
void write_mesh(const MeshOutput& output, const Mesh& mesh, MeshNotes notes, UpAxis up);

}  // namespace deburr
