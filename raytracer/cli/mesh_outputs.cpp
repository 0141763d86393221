#include "raytracer/cli/mesh_outputs.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "polygonizer/mesh/export_obj.hpp"
#include "raytracer/util/errors.hpp"
#include "raytracer/util/whole_file.hpp"

namespace deburr {
namespace {

namespace fs = std::filesystem;

// In the OBJ's folder, of the same name; what would end the line that names it is replaced.
std::string material_path(const fs::path& obj) {
    std::string name = obj.stem().string() + ".mtl";
    for (char& c : name)
        if (static_cast<unsigned char>(c) < ' ') c = '_';
    return (obj.parent_path() / name).string();
}

}  // namespace

std::vector<MeshOutput> mesh_outputs(const std::vector<std::string>& paths) {
    std::vector<MeshOutput> outputs;
    for (const std::string& path : paths) {
        const auto format = mesh_format(path);
        if (!format)
            throw UsageError(
                fmt::format("-o: expected a name that ends in one of {}, got '{}'", known_mesh_extensions(), path));
        outputs.push_back({path, *format, *format == MeshFormat::obj ? material_path(path) : ""});
    }
    return outputs;
}

std::vector<std::string> files_of(const std::vector<MeshOutput>& outputs) {
    std::vector<std::string> files;
    for (const MeshOutput& output : outputs) {
        files.push_back(output.path);
        if (!output.material_path.empty()) files.push_back(output.material_path);
    }
    return files;
}

void write_mesh(const MeshOutput& output, const Mesh& mesh, MeshNotes notes) {
    std::vector<FileBytes> files;
    if (!output.material_path.empty()) {
        notes.material_file = fs::path(output.material_path).filename().string();
        files.push_back({output.material_path, encode_mtl(mesh, notes)});
    }
    files.push_back({output.path, encode(mesh, output.format, notes)});
    write_whole_files(files);
}

}  // namespace deburr
