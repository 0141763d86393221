#include "polygonizer/mesh/export.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <stdexcept>

#include "polygonizer/mesh/export_3mf.hpp"
#include "polygonizer/mesh/export_bytes.hpp"
#include "polygonizer/mesh/export_color.hpp"
#include "polygonizer/mesh/export_glb.hpp"
#include "polygonizer/mesh/export_obj.hpp"
#include "polygonizer/mesh/separate_touching.hpp"
#include "polygonizer/mesh/single_precision.hpp"

namespace deburr {
namespace {

// The material of the largest triangle around each vertex, for readers that know no colours of faces.
std::vector<int> vertex_materials(const Mesh& mesh) {
    std::vector<int> materials(mesh.positions.size(), 0);
    std::vector<double> largest(mesh.positions.size(), -1);
    for (const Triangle& t : mesh.triangles) {
        const double size = glm::length(mesh.area_vector(t));
        for (const int v : t.vertex) {
            if (size <= largest[v]) continue;
            largest[v] = size;
            materials[v] = t.material;
        }
    }
    return materials;
}

std::string ply(const Mesh& mesh, const MeshNotes& notes) {
    std::vector<Vec3> normals(mesh.positions.size(), Vec3(0.0));
    for (const Triangle& t : mesh.triangles) {
        const Vec3 area = mesh.area_vector(t);
        const double size = glm::length(area);
        for (std::size_t k = 0; k < 3; ++k) normals[t.vertex[k]] += mesh.normals[t.normal[k]] * size;
    }
    const std::string color = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    std::string out = fmt::format(
        "ply\nformat binary_little_endian 1.0\ncomment Deburr\nelement vertex {0}\n"
        "property double x\nproperty double y\nproperty double z\n"
        "property double nx\nproperty double ny\nproperty double nz\n{2}"
        "element face {1}\nproperty list uchar int vertex_indices\n{2}end_header\n",
        mesh.positions.size(), mesh.triangles.size(), color);
    if (mesh.positions.size() > std::size_t(std::numeric_limits<std::int32_t>::max()))
        throw std::length_error("a mesh of more than 2 147 483 647 vertices does not fit PLY");
    const std::vector<int> materials = vertex_materials(mesh);
    std::map<int, std::array<std::uint8_t, 3>> colors;
    const auto put_color = [&](int material) {
        const auto [it, is_new] = colors.try_emplace(material);
        if (is_new) it->second = display_color(notes, material);
        for (const std::uint8_t c : it->second) out += char(c);
    };
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const double length = glm::length(normals[v]);
        const Vec3 n = length > 0 ? normals[v] / length : Vec3(0, 0, 1);
        for (int k = 0; k < 3; ++k) put(out, mesh.positions[v][k]);
        for (int k = 0; k < 3; ++k) put(out, n[k]);
        put_color(materials[v]);
    }
    for (const Triangle& t : mesh.triangles) {
        out += char(3);
        for (const int v : t.vertex) put_word(out, std::uint32_t(v));
        put_color(t.material);
    }
    return out;
}

std::string stl(const Mesh& mesh) {
    std::string out = "binary STL by Deburr";
    out.resize(80, ' ');
    put_word(out, count_of(mesh.triangles.size()));
    for (const Triangle& t : mesh.triangles) {
        put_floats(out, single_precision_normal(mesh, t));
        for (const int v : t.vertex) put_floats(out, mesh.positions[v]);
        out += std::string(2, '\0');
    }
    return out;
}

constexpr std::pair<const char*, MeshFormat> formats[] = {{".obj", MeshFormat::obj}, {".ply", MeshFormat::ply},
                                                          {".stl", MeshFormat::stl}, {".glb", MeshFormat::glb},
                                                          {".ase", MeshFormat::ase}, {".3mf", MeshFormat::three_mf}};

constexpr std::pair<const char*, LengthUnit> units[] = {{"micron", LengthUnit::micron},
                                                        {"millimeter", LengthUnit::millimeter},
                                                        {"centimeter", LengthUnit::centimeter},
                                                        {"inch", LengthUnit::inch},
                                                        {"foot", LengthUnit::foot},
                                                        {"meter", LengthUnit::meter}};

}  // namespace

const char* unit_name(LengthUnit unit) {
    for (const auto& [name, u] : units)
        if (u == unit) return name;
    return "";
}

std::optional<LengthUnit> find_unit(const std::string& name) {
    for (const auto& [known, unit] : units)
        if (name == known) return unit;
    return std::nullopt;
}

std::string known_units() {
    std::string all;
    for (const auto& [name, unit] : units) all += (all.empty() ? "" : ", ") + std::string(name);
    return all;
}

std::string solid_name(const MeshNotes& notes, int solid) {
    std::string name = std::size_t(solid) < notes.names.size() ? notes.names[solid] : "";
    for (char& c : name)
        if (static_cast<unsigned char>(c) <= ' ') c = '_';
    return name.empty() ? fmt::format("solid_{}", solid + 1) : name;
}

std::optional<MeshFormat> mesh_format(const std::string& path) {
    const std::size_t dot = path.find_last_of("./");
    if (dot == std::string::npos || path[dot] == '/') return std::nullopt;
    std::string extension = path.substr(dot);
    for (char& c : extension)
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    for (const auto& [name, format] : formats)
        if (extension == name) return format;
    return std::nullopt;
}

std::string known_mesh_extensions() {
    std::string all;
    for (const auto& [name, format] : formats) all += (all.empty() ? "" : ", ") + std::string(name);
    return all;
}

std::string encode(const Mesh& mesh, MeshFormat format, const MeshNotes& notes) {
    if (format == MeshFormat::obj) return encode_obj(mesh, notes);
    if (format == MeshFormat::ply) return ply(mesh, notes);
    if (format == MeshFormat::ase) return encode_ase(mesh, notes);
    if (format == MeshFormat::three_mf) return encode_3mf(mesh, notes);
    Mesh apart = mesh;  // touching parts are separated in single precision, too
    separate_touching(apart, single_precision_step(mesh));
    return format == MeshFormat::stl ? stl(apart) : encode_glb(apart, notes);
}

}  // namespace deburr
