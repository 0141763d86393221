// Mesh files in every format, read back; and marching cubes on the cases that are ambiguous for it.
#include "polygonizer/mesh/export.hpp"

#include <zlib.h>

#include <array>
#include <chrono>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>
#include <thread>

#include "catch.hpp"
#include "polygonizer/marching_cubes/marching_cubes.hpp"
#include "polygonizer/mesh/metrics.hpp"
#include "polygonizer/triage/triage.hpp"

using namespace deburr;

namespace {

SolidTree scene() {
    return flatten(Solid::rounded(0.1, Density::box(Vec3(0.0), Vec3(1.0, 1.0 / 3, 0.7))) -
                   Solid::sharp(Density::box({0.5, -1, 0.3}, {2, 2, 2})));
}

Mesh mesh() {
    const SolidTree tree = scene();
    return triage(tree, polygonization_box(tree));
}

template <class T>
T read(const std::string& bytes, std::size_t at) {
    T x;
    std::memcpy(&x, bytes.data() + at, sizeof x);
    return x;
}

}  // namespace

TEST_CASE("OBJ reads back as the same doubles and the same triangles") {
    const Mesh m = mesh();
    std::istringstream in(encode(m, MeshFormat::obj));
    std::size_t vertices = 0, faces = 0;
    std::string line, word;
    while (std::getline(in, line)) {
        std::istringstream words(line);
        words >> word;
        if (word == "v") {
            for (int k = 0; k < 3; ++k) {
                words >> word;
                CHECK(std::stod(word) == m.positions[vertices][k]);
            }
            ++vertices;
        } else if (word == "f") {
            for (std::size_t k = 0; k < 3; ++k) {
                words >> word;
                CHECK(std::stoi(word) == m.triangles[faces].vertex[k] + 1);
            }
            ++faces;
        }
    }
    CHECK(vertices == m.positions.size());
    CHECK(faces == m.triangles.size());
}

TEST_CASE("Binary files have the size that they say") {
    const Mesh m = mesh();
    const std::string stl = encode(m, MeshFormat::stl), ply = encode(m, MeshFormat::ply),
                      glb = encode(m, MeshFormat::glb);
    CHECK(stl.size() == 84 + 50 * m.triangles.size());
    CHECK(read<std::uint32_t>(stl, 80) == m.triangles.size());
    const std::size_t header = ply.find("end_header\n") + 11;
    CHECK(ply.size() == header + 51 * m.positions.size() + 16 * m.triangles.size());
    CHECK(read<double>(ply, header + 8) == m.positions[0].y);
    CHECK(read<std::uint32_t>(glb, 8) == glb.size());
}

TEST_CASE("A PLY's faces have the colours of their materials, and its vertices one of those around them") {
    const SolidTree tree = flatten(Solid::rounded(0.1, Density::box(Vec3(0.0), Vec3(1.0, 1.0 / 3, 0.7))).material(1) -
                                   Solid::sharp(Density::box({0.5, -1, 0.3}, {2, 2, 2})).material(2));
    const Mesh m = triage(tree, polygonization_box(tree));
    const std::string ply = encode(m, MeshFormat::ply, {{}, {Vec3(1.0), Vec3(1, 0, 0.21586), Vec3(0, 1, 0.0031308)}});
    using Color = std::array<std::uint8_t, 3>;
    const Color expected[3] = {{255, 255, 255}, {255, 0, 128}, {0, 255, 10}};
    const std::size_t vertices = ply.find("end_header\n") + 11, faces = vertices + 51 * m.positions.size();
    std::vector<std::set<Color>> around(m.positions.size());
    std::set<Color> seen;
    for (std::size_t t = 0; t < m.triangles.size(); ++t) {
        const Color color = read<Color>(ply, faces + 16 * t + 13);
        CHECK(color == expected[m.triangles[t].material]);
        seen.insert(color);
        for (const int v : m.triangles[t].vertex) around[v].insert(color);
    }
    CHECK(seen.size() == 2);
    for (std::size_t v = 0; v < around.size(); ++v) CHECK(around[v].count(read<Color>(ply, vertices + 51 * v + 48)));
}

TEST_CASE("A GLB's accessors lie within its buffer") {
    const std::string glb = encode(mesh(), MeshFormat::glb);
    const std::uint32_t length = read<std::uint32_t>(glb, 12);
    const auto j = nlohmann::json::parse(glb.substr(20, length));
    const std::size_t bytes = j["buffers"][0]["byteLength"];
    CHECK(glb.size() == 20 + length + 8 + bytes);
    for (const auto& a : j["accessors"]) {
        const auto& view = j["bufferViews"].at(a["bufferView"].get<std::size_t>());
        const std::size_t size = std::size_t(a["count"]) * (a["type"] == "VEC3" ? 12 : 4);
        CHECK(std::size_t(view["byteLength"]) == size);
        CHECK(std::size_t(view["byteOffset"]) + size <= bytes);
    }
}

TEST_CASE("An empty mesh is a file in every format") {
    for (const MeshFormat f :
         {MeshFormat::obj, MeshFormat::ply, MeshFormat::stl, MeshFormat::glb, MeshFormat::ase, MeshFormat::three_mf})
        CHECK_FALSE(encode(Mesh{}, f).empty());
}

TEST_CASE("The format follows from the name") {
    CHECK(mesh_format("a.OBJ") == MeshFormat::obj);
    CHECK(mesh_format("dir.stl/a.glb") == MeshFormat::glb);
    CHECK_FALSE(mesh_format("dir.stl/a"));
    CHECK_FALSE(mesh_format("a.png"));
}

TEST_CASE("Marching cubes is closed, and as near as the paper's grid allows") {
    const SolidTree tree = scene();
    const Box box = polygonization_box(tree);
    const MeshMetrics m = measure(marching_cubes(tree, box, 0.04), tree);
    CHECK(m.topology.manifold());
    CHECK(m.topology.euler == 2);
    CHECK(m.vertex_distance < 1e-6);
    CHECK(m.volume > 0);
}

TEST_CASE("Marching cubes closes ambiguous faces: a checkerboard of boxes") {
    Density all = Density::box({0, 0, 0}, {1, 1, 1});
    for (const Vec3 at : {Vec3(1, 1, 0), Vec3(1, 0, 1), Vec3(0, 1, 1)}) all = all + Density::box(at, at + Vec3(1.0));
    const SolidTree tree = flatten(Solid::rounded(0.2, all));
    for (const double grid : {0.3, 0.1, 0.07})
        CHECK(topology(marching_cubes(tree, polygonization_box(tree), grid)).closed());
}

// The model's XML in a 3MF archive. This reader handles only archives that encode() writes.
std::string model_of(const std::string& archive) {
    const std::string name = "3D/3dmodel.model";
    const std::size_t header = archive.find(name) - 30;  // local file header [APPNOTE 4.3.7]
    const auto word = [&](std::size_t at) { return read<std::uint32_t>(archive, header + at); };
    std::string text(word(22), '\0');
    z_stream stream{};
    REQUIRE(inflateInit2(&stream, -MAX_WBITS) == Z_OK);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(archive.data() + header + 30 + name.size()));
    stream.avail_in = word(18);
    stream.next_out = reinterpret_cast<Bytef*>(text.data());
    stream.avail_out = uInt(text.size());
    CHECK(inflate(&stream, Z_FINISH) == Z_STREAM_END);
    inflateEnd(&stream);
    CHECK(crc32(0, reinterpret_cast<const Bytef*>(text.data()), uInt(text.size())) == word(14));
    return text;
}

TEST_CASE("A 3MF has the same bytes at any time, and vertices that read back as the same doubles") {
    const Mesh m = mesh();
    const std::string archive = encode(m, MeshFormat::three_mf);
    CHECK(read<std::uint16_t>(archive, 10) == 0);                  // midnight
    CHECK(read<std::uint16_t>(archive, 12) == (1 << 5 | 1));       // 1980-01-01
    std::this_thread::sleep_for(std::chrono::milliseconds(2100));  // dates in a ZIP have steps of two seconds
    CHECK(encode(m, MeshFormat::three_mf) == archive);
    const std::string text = model_of(archive);
    const std::regex vertex("<vertex x=\"([^\"]*)\" y=\"([^\"]*)\" z=\"([^\"]*)\"/>");
    std::set<std::array<double, 3>> read, expected;
    std::size_t count = 0;
    for (std::sregex_iterator at(text.begin(), text.end(), vertex), end; at != end; ++at, ++count)
        read.insert({std::stod((*at)[1]), std::stod((*at)[2]), std::stod((*at)[3])});
    for (const Vec3& x : m.positions) expected.insert({x.x, x.y, x.z});
    CHECK(count == m.positions.size());
    CHECK(read == expected);
}

TEST_CASE("An STL's normals are those of the corners that it has") {
    Mesh mesh;
    // In doubles the triangle leans; in single precision, at x = 1000, it does not.
    mesh.positions = {{1000, 0, 0}, {1001, 0, 0}, {1000.00001, 1, 0}, {1000.00002, 0, 1}};
    mesh.normals = {{0, 0, 1}};
    mesh.triangles = {{{0, 3, 2}, {0, 0, 0}}};
    const std::string bytes = encode(mesh, MeshFormat::stl);
    std::array<float, 3> normal;
    std::memcpy(normal.data(), bytes.data() + 84, sizeof normal);
    CHECK(normal == std::array<float, 3>{-1, 0, 0});
}

TEST_CASE("A GLB's bounds of positions are those of the numbers in its buffer") {
    const std::string glb = encode(mesh(), MeshFormat::glb);
    const std::uint32_t length = read<std::uint32_t>(glb, 12);
    const auto j = nlohmann::json::parse(glb.substr(20, length));
    int bounds = 0;
    for (const auto& a : j["accessors"]) {
        if (!a.contains("min")) continue;
        const std::size_t from = 28 + length + j["bufferViews"][a["bufferView"].get<int>()]["byteOffset"].get<int>();
        glm::vec3 lo(infinity), hi(-infinity);
        for (std::size_t v = 0; v < a["count"].get<std::size_t>(); ++v) {
            const auto x = read<glm::vec3>(glb, from + 12 * v);
            lo = glm::min(lo, x);
            hi = glm::max(hi, x);
        }
        for (int k = 0; k < 3; ++k) {
            CHECK(a["min"][k].get<double>() == lo[k]);
            CHECK(a["max"][k].get<double>() == hi[k]);
        }
        ++bounds;
    }
    CHECK(bounds > 0);
}

TEST_CASE("A GLB has the surfaces of its materials by glTF's names") {
    MeshNotes notes;
    notes.colors = {{0.5, 0.25, 0.125}};
    notes.surfaces = {{.metallic = 0.25,
                       .roughness = 0.5,
                       .ior = 1.33,
                       .transmission = 0.75,
                       .clearcoat = 0.5,
                       .clearcoat_roughness = 0.125,
                       .emission = {4, 2, 0}}};
    const std::string glb = encode(mesh(), MeshFormat::glb, notes);
    const auto j = nlohmann::json::parse(glb.substr(20, read<std::uint32_t>(glb, 12)));
    const auto& m = j["materials"][0];
    CHECK(m["pbrMetallicRoughness"]["baseColorFactor"] == nlohmann::json({0.5, 0.25, 0.125, 1.0}));
    CHECK(m["pbrMetallicRoughness"]["metallicFactor"] == 0.25);
    CHECK(m["pbrMetallicRoughness"]["roughnessFactor"] == 0.5);
    CHECK(m["extensions"]["KHR_materials_ior"]["ior"] == 1.33);
    CHECK(m["extensions"]["KHR_materials_transmission"]["transmissionFactor"] == 0.75);
    CHECK(m["extensions"]["KHR_materials_clearcoat"]["clearcoatFactor"] == 0.5);
    CHECK(m["extensions"]["KHR_materials_clearcoat"]["clearcoatRoughnessFactor"] == 0.125);
    CHECK(m["emissiveFactor"] == nlohmann::json({1.0, 0.5, 0.0}));
    CHECK(m["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] == 4.0);
    CHECK(j["extensionsUsed"].size() == 4);
}
