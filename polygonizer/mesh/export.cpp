#include "polygonizer/mesh/export.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "polygonizer/mesh/export_3mf.hpp"
#include "polygonizer/mesh/export_color.hpp"
#include "polygonizer/mesh/export_obj.hpp"
#include "polygonizer/mesh/separate_touching.hpp"
#include "polygonizer/mesh/single_precision.hpp"

namespace deburr {
namespace {

static_assert(std::numeric_limits<float>::is_iec559 && sizeof(float) == 4);

void put_word(std::string& out, std::uint32_t x) {
    for (int k = 0; k < 4; ++k) out += char(x >> (8 * k) & 0xff);
}

void put(std::string& out, float x) {
    std::uint32_t bits;
    std::memcpy(&bits, &x, 4);
    put_word(out, bits);
}

void put(std::string& out, double x) {
    std::uint64_t bits;
    std::memcpy(&bits, &x, 8);
    put_word(out, std::uint32_t(bits));
    put_word(out, std::uint32_t(bits >> 32));
}

void put_floats(std::string& out, Vec3 x) {
    for (int k = 0; k < 3; ++k) put(out, float(x[k]));
}

std::uint32_t count_of(std::size_t n) {
    if (n > std::numeric_limits<std::uint32_t>::max())
        throw std::length_error("a mesh of more than 4 294 967 295 elements does not fit the format");
    return std::uint32_t(n);
}

// Of each vertex, for readers that know no colours of faces: that of the largest triangle around it.
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

// One primitive of a glTF mesh, with a vertex for every pair of position and normal.
struct Primitive {
    std::vector<std::pair<int, int>> vertices;
    std::map<std::pair<int, int>, std::uint32_t> known;
    std::vector<std::uint32_t> indices;
};

using Json = nlohmann::ordered_json;

// A material of glTF 2.0; the extensions that it uses are added to `used`.
static Json glb_material(const MeshNotes& notes, int index, std::set<std::string>& used) {
    const Vec3 c = material_color(notes, index);
    Json material = {{"pbrMetallicRoughness", {{"baseColorFactor", {c.x, c.y, c.z, 1.0}}, {"metallicFactor", 0.0}}}};
    if (std::size_t(index) >= notes.surfaces.size()) return material;
    const SurfaceNotes& s = notes.surfaces[index];
    material["pbrMetallicRoughness"]["metallicFactor"] = s.metallic;
    material["pbrMetallicRoughness"]["roughnessFactor"] = s.roughness;
    const auto extend = [&](const char* name, Json value) {
        material["extensions"][name] = std::move(value);
        used.insert(name);
    };
    if (s.ior != 1.5) extend("KHR_materials_ior", {{"ior", s.ior}});
    if (s.transmission > 0) extend("KHR_materials_transmission", {{"transmissionFactor", s.transmission}});
    if (s.clearcoat > 0)
        extend("KHR_materials_clearcoat",
               {{"clearcoatFactor", s.clearcoat}, {"clearcoatRoughnessFactor", s.clearcoat_roughness}});
    const double strength = std::max({s.emission.x, s.emission.y, s.emission.z});
    if (strength > 0) {
        const Vec3 e = s.emission / std::max(1.0, strength);
        material["emissiveFactor"] = {e.x, e.y, e.z};
        if (strength > 1) extend("KHR_materials_emissive_strength", {{"emissiveStrength", strength}});
    }
    return material;
}

std::string glb(const Mesh& mesh, const MeshNotes& notes) {
    std::map<std::pair<int, int>, Primitive> primitives;  // by solid, material
    for (const Triangle& t : mesh.triangles) {
        Primitive& p = primitives[{t.solid, t.material}];
        for (std::size_t k = 0; k < 3; ++k) {
            const std::pair<int, int> corner{t.vertex[k], t.normal[k]};
            const auto [it, is_new] = p.known.try_emplace(corner, count_of(p.vertices.size()));
            if (is_new) p.vertices.push_back(corner);
            p.indices.push_back(it->second);
        }
    }
    std::string data;
    Json j;
    j["asset"] = {{"version", "2.0"}, {"generator", "Deburr"}};
    j["scene"] = 0;
    j["scenes"] = Json::array({Json{{"nodes", Json::array()}}});
    j["nodes"] = j["meshes"] = j["materials"] = j["accessors"] = j["bufferViews"] = Json::array();
    const auto view = [&](std::size_t from, int target) {
        j["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", from}, {"byteLength", data.size() - from}, {"target", target}});
        return j["bufferViews"].size() - 1;
    };
    constexpr int array_buffer = 34962, element_array_buffer = 34963, is_float = 5126, is_uint = 5125;
    std::map<int, std::size_t> material_of;
    std::set<std::string> extensions;
    int solid = -1;
    for (const auto& [key, p] : primitives) {
        if (key.first != solid) {
            solid = key.first;
            j["scenes"][0]["nodes"].push_back(j["nodes"].size());
            j["nodes"].push_back({{"mesh", j["meshes"].size()}, {"name", solid_name(notes, solid)}});
            j["meshes"].push_back({{"primitives", Json::array()}});
        }
        const auto [material, is_new] = material_of.try_emplace(key.second, j["materials"].size());
        if (is_new) {
            j["materials"].push_back(glb_material(notes, key.second, extensions));
        }
        Vec3 lo(infinity), hi(-infinity);
        std::size_t from = data.size();
        for (const auto& [v, n] : p.vertices) {
            const Vec3 x = Vec3(glm::vec3(mesh.positions[v]));
            lo = glm::min(lo, x);
            hi = glm::max(hi, x);
            put_floats(data, x);
        }
        const std::size_t positions = j["accessors"].size();
        j["accessors"].push_back({{"bufferView", view(from, array_buffer)},
                                  {"componentType", is_float},
                                  {"count", p.vertices.size()},
                                  {"type", "VEC3"},
                                  {"min", {lo.x, lo.y, lo.z}},
                                  {"max", {hi.x, hi.y, hi.z}}});
        from = data.size();
        for (const auto& [v, n] : p.vertices) put_floats(data, mesh.normals[n]);
        j["accessors"].push_back({{"bufferView", view(from, array_buffer)},
                                  {"componentType", is_float},
                                  {"count", p.vertices.size()},
                                  {"type", "VEC3"}});
        from = data.size();
        for (const std::uint32_t i : p.indices) put_word(data, i);
        j["accessors"].push_back({{"bufferView", view(from, element_array_buffer)},
                                  {"componentType", is_uint},
                                  {"count", p.indices.size()},
                                  {"type", "SCALAR"}});
        j["meshes"].back()["primitives"].push_back(
            {{"attributes", {{"POSITION", positions}, {"NORMAL", positions + 1}}},
             {"indices", positions + 2},
             {"material", material->second}});
    }
    j["buffers"] = Json::array({Json{{"byteLength", data.size()}}});
    for (const std::string& name : extensions) j["extensionsUsed"].push_back(name);
    for (const char* list : {"nodes", "meshes", "materials", "accessors", "bufferViews", "buffers"})
        if (j[list].empty() || data.empty()) j.erase(list);  // glTF has no empty lists
    if (data.empty()) j["scenes"] = Json::array({Json::object()});
    std::string text = j.dump(-1, ' ', false, Json::error_handler_t::replace);
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string out = "glTF";
    put_word(out, 2);
    put_word(out, count_of(12 + 8 + text.size() + (data.empty() ? 0 : 8 + data.size())));
    put_word(out, count_of(text.size()));
    out += "JSON" + text;
    if (data.empty()) return out;
    put_word(out, count_of(data.size()));
    out += std::string("BIN\0", 4) + data;
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
    Mesh apart = mesh;  // in single precision too
    separate_touching(apart, single_precision_step(mesh));
    return format == MeshFormat::stl ? stl(apart) : glb(apart, notes);
}

}  // namespace deburr
