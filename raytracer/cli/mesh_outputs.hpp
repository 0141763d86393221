// The files that `deburr mesh` writes. "%n" in a name stands for a solid's name or number, and asks for a file for each
// solid.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "polygonizer/mesh/export.hpp"
#include "raytracer/mesh/scene_mesh.hpp"

namespace deburr {

/// A file of a mesh, and what must be written with it.
struct MeshOutput {
    std::string path;
    MeshFormat format;
    std::string material_path = {};         // the MTL beside an OBJ; "": none
    std::optional<std::size_t> solid = {};  // of the scene, from 0; none: all
};

/// Throws UsageError if one of `paths` (-o) has an ending that is no format.
void check_mesh_names(const std::vector<std::string>& paths);

/// The files that `paths` ask for, of these solids of the scene, in order; no solids: of all.
std::vector<MeshOutput> mesh_outputs(const std::vector<std::string>& paths, const Scene& scene,
                                     const std::vector<std::size_t>& solids);

/// The names of all of them.
std::vector<std::string> files_of(const std::vector<MeshOutput>& outputs);

/// Which way is up in the files.
enum class UpAxis { y, z };

/// --up; "" is the scene's own. Throws UsageError.
UpAxis parse_up(const std::string& text, bool scene_is_z_up);

/// Throws WorkError; the files of one output appear together or not at all, and none for a solid that has no mesh. GLB
/// is y-up whatever is asked, for glTF is.
void write_mesh(const MeshOutput& output, const SceneMesh& mesh, MeshNotes notes, bool scene_is_z_up, UpAxis up);

}  // namespace deburr
