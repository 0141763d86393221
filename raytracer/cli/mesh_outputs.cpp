#include "raytracer/cli/mesh_outputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "polygonizer/mesh/export_obj.hpp"
#include "raytracer/cli/solid_choice.hpp"
#include "raytracer/util/errors.hpp"
#include "raytracer/util/whole_file.hpp"

namespace deburr {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view solid_mark = "%n";

// The path of the MTL: in the OBJ's folder, with its stem; control characters, which would end its line in the OBJ, are
// replaced.
std::string material_path(const fs::path& obj) {
    std::string name = obj.stem().string() + ".mtl";
    for (char& c : name)
        if (static_cast<unsigned char>(c) < ' ') c = '_';
    return (obj.parent_path() / name).string();
}

// The pattern with all marks replaced by the name.
std::string with_name(std::string pattern, const std::string& name) {
    for (std::size_t at = pattern.find(solid_mark); at != std::string::npos;
         at = pattern.find(solid_mark, at + name.size()))
        pattern.replace(at, solid_mark.size(), name);
    return pattern;
}

// Rotates by a quarter turn about the x axis, from y up to z up or back; 0.0 - x makes no −0.
void turn(Mesh& mesh, UpAxis to) {
    for (std::vector<Vec3>* vectors : {&mesh.positions, &mesh.normals})
        for (Vec3& v : *vectors) v = to == UpAxis::z ? Vec3(v.x, 0.0 - v.z, v.y) : Vec3(v.x, v.z, 0.0 - v.y);
}

}  // namespace

void check_mesh_names(const std::vector<std::string>& paths) {
    for (const std::string& path : paths)
        if (!mesh_format(path))
            throw UsageError(
                fmt::format("-o: expected a name that ends in one of {}, got '{}'", known_mesh_extensions(), path));
}

std::vector<MeshOutput> mesh_outputs(const std::vector<std::string>& paths, const Scene& scene,
                                     const std::vector<std::size_t>& solids) {
    std::vector<MeshOutput> outputs;
    const auto add = [&](const std::string& path, MeshFormat format, std::optional<std::size_t> solid) {
        outputs.push_back({path, format, format == MeshFormat::obj ? material_path(path) : "", solid});
    };
    const std::vector<std::string> names = file_names(scene);
    for (const std::string& path : paths) {
        if (path.find(solid_mark) == std::string::npos) {
            add(path, *mesh_format(path), std::nullopt);
            continue;
        }
        for (std::size_t i = 0; i < scene.solids.size(); ++i)
            if (solids.empty() || std::binary_search(solids.begin(), solids.end(), i))
                add(with_name(path, names[i]), *mesh_format(path), i);
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

UpAxis parse_up(const std::string& text, bool scene_is_z_up) {
    if (text.empty()) return scene_is_z_up ? UpAxis::z : UpAxis::y;
    if (text == "y") return UpAxis::y;
    if (text == "z") return UpAxis::z;
    throw UsageError(fmt::format("--up: expected y or z, got '{}'", text));
}

void write_mesh(const MeshOutput& output, const SceneMesh& all, MeshNotes notes, bool scene_is_z_up, UpAxis up) {
    Mesh mesh;
    if (output.solid)
        mesh.append(all.parts[*output.solid], int(*output.solid));
    else
        mesh = all.mesh;
    if (output.solid && mesh.triangles.empty()) return;
    const UpAxis wanted = output.format == MeshFormat::glb ? UpAxis::y : up;
    if (wanted != (scene_is_z_up ? UpAxis::z : UpAxis::y)) turn(mesh, wanted);
    std::vector<FileBytes> files;
    if (!output.material_path.empty()) {
        notes.material_file = fs::path(output.material_path).filename().string();
        files.push_back({output.material_path, encode_mtl(mesh, notes)});
    }
    files.push_back({output.path, encode(mesh, output.format, notes)});
    write_whole_files(files);
}

}  // namespace deburr
