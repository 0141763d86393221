// The files that `deburr mesh` writes. "%n" in a file name stands for a solid's name or number, and writes one file per
// solid.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "polygonizer/mesh/export.hpp"
#include "raytracer/mesh/scene_mesh.hpp"

namespace deburr {

/// A mesh file to be written, with its companion.
struct MeshOutput {
    std::string path;
    MeshFormat format;
    std::string material_path = {};         // the MTL of an OBJ; "": none
    std::optional<std::size_t> solid = {};  // index of the only solid in it; none: all solids
};

/// Throws UsageError if one of `paths` (-o) has an extension that is not a mesh format.
void check_mesh_names(const std::vector<std::string>& paths);

/// The files for `paths`, of these solids of the scene; an empty list means all solids.
std::vector<MeshOutput> mesh_outputs(const std::vector<std::string>& paths, const Scene& scene,
                                     const std::vector<std::size_t>& solids);

/// The paths of all files, companions included.
std::vector<std::string> files_of(const std::vector<MeshOutput>& outputs);

/// The up axis of mesh files.
enum class UpAxis { y, z };

/// Parses --up; "" is the scene's own axis. Throws UsageError.
UpAxis parse_up(const std::string& text, bool scene_is_z_up);

/// Writes the files of one output together or not at all, and none for a solid without a mesh. GLB always has y up, as
/// glTF requires. Throws WorkError.
void write_mesh(const MeshOutput& output, const SceneMesh& mesh, MeshNotes notes, bool scene_is_z_up, UpAxis up);

}  // namespace deburr
