#include "polygonizer/mesh/export_glb.hpp"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "polygonizer/mesh/export_bytes.hpp"
#include "polygonizer/mesh/export_color.hpp"

namespace deburr {
namespace {

using Json = nlohmann::ordered_json;

// One primitive of a glTF mesh, with a vertex for every pair of position and normal that occurs.
struct Primitive {
    std::vector<std::pair<int, int>> vertices;
    std::map<std::pair<int, int>, std::uint32_t> known;
    std::vector<std::uint32_t> indices;
};

// The mesh's primitives by (solid, material).
std::map<std::pair<int, int>, Primitive> primitives_of(const Mesh& mesh) {
    std::map<std::pair<int, int>, Primitive> primitives;
    for (const Triangle& t : mesh.triangles) {
        Primitive& p = primitives[{t.solid, t.material}];
        for (std::size_t k = 0; k < 3; ++k) {
            const std::pair<int, int> corner{t.vertex[k], t.normal[k]};
            const auto [it, is_new] = p.known.try_emplace(corner, count_of(p.vertices.size()));
            if (is_new) p.vertices.push_back(corner);
            p.indices.push_back(it->second);
        }
    }
    return primitives;
}

// A glTF 2.0 material; the extensions that it needs are added to `used`.
Json glb_material(const MeshNotes& notes, int index, std::set<std::string>& used) {
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
    const double strength = max_component(s.emission);
    if (strength > 0) {
        const Vec3 e = s.emission / std::max(1.0, strength);
        material["emissiveFactor"] = {e.x, e.y, e.z};
        if (strength > 1) extend("KHR_materials_emissive_strength", {{"emissiveStrength", strength}});
    }
    return material;
}

// A file as it grows: the JSON chunk that describes it, and the binary chunk.
class Glb {
public:
    Glb(const Mesh& mesh, const MeshNotes& notes) : mesh_(mesh), notes_(notes) {
        json_["asset"] = {{"version", "2.0"}, {"generator", "Deburr"}};
        json_["scene"] = 0;
        json_["scenes"] = Json::array({Json{{"nodes", Json::array()}}});
        for (const char* list : {"bufferViews", "accessors", "materials", "meshes", "nodes"})
            json_[list] = Json::array();
    }

    // Begins a node of the scene, with a mesh that has no primitives yet.
    void begin_solid(int solid) {
        json_["scenes"][0]["nodes"].push_back(json_["nodes"].size());
        json_["nodes"].push_back({{"mesh", json_["meshes"].size()}, {"name", solid_name(notes_, solid)}});
        json_["meshes"].push_back({{"primitives", Json::array()}});
    }

    // Adds a primitive to the latest mesh.
    void add(const Primitive& p, int material) {
        const std::size_t number = material_number(material), positions = add_positions(p);
        add_normals(p);
        add_indices(p);
        json_["meshes"].back()["primitives"].push_back(
            {{"attributes", {{"POSITION", positions}, {"NORMAL", positions + 1}}},
             {"indices", positions + 2},
             {"material", number}});
    }

    std::string encoded() {
        json_["buffers"] = Json::array({Json{{"byteLength", data_.size()}}});
        for (const std::string& name : extensions_) json_["extensionsUsed"].push_back(name);
        for (const char* list : {"nodes", "meshes", "materials", "accessors", "bufferViews", "buffers"})
            if (json_[list].empty() || data_.empty()) json_.erase(list);  // glTF has no empty lists
        if (data_.empty()) json_["scenes"] = Json::array({Json::object()});
        std::string text = json_.dump(-1, ' ', false, Json::error_handler_t::replace);
        text.resize((text.size() + 3) / 4 * 4, ' ');
        std::string out = "glTF";
        put_word(out, 2);
        put_word(out, count_of(12 + 8 + text.size() + (data_.empty() ? 0 : 8 + data_.size())));
        put_word(out, count_of(text.size()));
        out += "JSON" + text;
        if (data_.empty()) return out;
        put_word(out, count_of(data_.size()));
        out += std::string("BIN\0", 4) + data_;
        return out;
    }

private:
    // WebGL's constants that glTF uses.
    static constexpr int array_buffer = 34962, element_array_buffer = 34963, is_float = 5126, is_uint = 5125;

    std::size_t material_number(int material) {
        const auto [at, is_new] = material_of_.try_emplace(material, json_["materials"].size());
        if (is_new) json_["materials"].push_back(glb_material(notes_, material, extensions_));
        return at->second;
    }

    // Each of the following three functions appends data to the buffer and an accessor for it; the first returns its
    // accessor's index.
    std::size_t add_positions(const Primitive& p) {
        // Minimum and maximum of the numbers as written. They are in single precision throughout, because GCC 12
        // optimizes the conversion to single precision and back away.
        glm::vec3 lo(infinity), hi(-infinity);
        const std::size_t from = data_.size();
        for (const auto& [v, n] : p.vertices) {
            const glm::vec3 x(mesh_.positions[v]);
            lo = glm::min(lo, x);
            hi = glm::max(hi, x);
            for (int k = 0; k < 3; ++k) put(data_, x[k]);
        }
        add_accessor(from, array_buffer, is_float, p.vertices.size(), "VEC3");
        json_["accessors"].back()["min"] = {lo.x, lo.y, lo.z};
        json_["accessors"].back()["max"] = {hi.x, hi.y, hi.z};
        return json_["accessors"].size() - 1;
    }
    void add_normals(const Primitive& p) {
        const std::size_t from = data_.size();
        for (const auto& [v, n] : p.vertices) put_floats(data_, mesh_.normals[n]);
        add_accessor(from, array_buffer, is_float, p.vertices.size(), "VEC3");
    }
    void add_indices(const Primitive& p) {
        const std::size_t from = data_.size();
        for (const std::uint32_t i : p.indices) put_word(data_, i);
        add_accessor(from, element_array_buffer, is_uint, p.indices.size(), "SCALAR");
    }

    // Adds an accessor of the buffer from `from` to its end.
    void add_accessor(std::size_t from, int target, int component, std::size_t count, const char* type) {
        json_["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", from}, {"byteLength", data_.size() - from}, {"target", target}});
        json_["accessors"].push_back({{"bufferView", json_["bufferViews"].size() - 1},
                                      {"componentType", component},
                                      {"count", count},
                                      {"type", type}});
    }

    const Mesh& mesh_;
    const MeshNotes& notes_;
    Json json_;
    std::string data_;
    std::map<int, std::size_t> material_of_;  // index in the file by the scene's material
    std::set<std::string> extensions_;        // extensions that the materials need
};

}  // namespace

std::string encode_glb(const Mesh& mesh, const MeshNotes& notes) {
    Glb file(mesh, notes);
    int solid = -1;
    for (const auto& [key, primitive] : primitives_of(mesh)) {
        if (key.first != solid) file.begin_solid(solid = key.first);
        file.add(primitive, key.second);
    }
    return file.encoded();
}

}  // namespace deburr
