#include "raytracer/cli/mesh_outputs.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <optional>

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

// A quarter of a turn about the x axis.
Mesh z_up(Mesh mesh) {
    for (std::vector<Vec3>* vectors : {&mesh.positions, &mesh.normals})
        for (Vec3& v : *vectors) v = Vec3(v.x, 0.0 - v.z, v.y);  // no −0
    return mesh;
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

UpAxis parse_up(const std::string& text) {
    if (text.empty() || text == "y") return UpAxis::y;
    if (text == "z") return UpAxis::z;
    throw UsageError(fmt::format("--up: expected y or z, got '{}'", text));
}

void write_mesh(const MeshOutput& output, const Mesh& y_up, MeshNotes notes, UpAxis up) {
    std::optional<Mesh> turned;
    if (up == UpAxis::z && output.format != MeshFormat::glb) turned = z_up(y_up);
    const Mesh& mesh = turned ? *turned : y_up;
    std::vector<FileBytes> files;
    if (!output.material_path.empty()) {
        notes.material_file = fs::path(output.material_path).filename().string();
        files.push_back({output.material_path, encode_mtl(mesh, notes)});
    }
    files.push_back({output.path, encode(mesh, output.format, notes)});
    write_whole_files(files);
}

}  // namespace deburr
