#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "polygonizer/mesh/export_color.hpp"
#include "polygonizer/mesh/mesh_objects.hpp"

namespace deburr {
namespace {

using Out = std::back_insert_iterator<fmt::memory_buffer>;

constexpr const char* identity =
    "\t\t*TM_ROW0 1 0 0\n\t\t*TM_ROW1 0 1 0\n\t\t*TM_ROW2 0 0 1\n\t\t*TM_ROW3 0 0 0\n"
    "\t\t*TM_POS 0 0 0\n\t\t*TM_ROTAXIS 0 0 0\n\t\t*TM_ROTANGLE 0\n\t\t*TM_SCALE 1 1 1\n";

// The text in quotes, in which the format has no escapes.
std::string quoted(std::string name) {
    std::replace(name.begin(), name.end(), '"', '_');
    return '"' + name + '"';
}

void put_material(Out to, const char* indent, const std::string& name, const char* kind, Vec3 color) {
    fmt::format_to(to, "{0}*MATERIAL_NAME {1}\n{0}*MATERIAL_CLASS \"{2}\"\n", indent, quoted(name), kind);
    for (const char* what : {"AMBIENT", "DIFFUSE"})
        fmt::format_to(to, "{}*MATERIAL_{} {} {} {}\n", indent, what, color.x, color.y, color.z);
    fmt::format_to(to, "{0}*MATERIAL_SPECULAR 0 0 0\n{0}*MATERIAL_TRANSPARENCY 0\n", indent);
}

void put_object(Out to, const Mesh& mesh, const MeshObject& object, const MeshNotes& notes) {
    const std::string name = quoted(solid_name(notes, mesh.triangles[object.begin].solid));
    fmt::format_to(to, "*GEOMOBJECT {{\n\t*NODE_NAME {0}\n\t*NODE_TM {{\n\t\t*NODE_NAME {0}\n{1}\t}}\n", name,
                   identity);
    fmt::format_to(
        to, "\t*MESH {{\n\t\t*TIMEVALUE 0\n\t\t*MESH_NUMVERTEX {}\n\t\t*MESH_NUMFACES {}\n\t\t*MESH_VERTEX_LIST {{\n",
        object.positions.size(), object.triangles.size());
    for (std::size_t v = 0; v < object.positions.size(); ++v) {
        const Vec3 x = mesh.positions[object.positions[v]];
        fmt::format_to(to, "\t\t\t*MESH_VERTEX {}\t{}\t{}\t{}\n", v, x.x, x.y, x.z);
    }
    fmt::format_to(to, "\t\t}}\n\t\t*MESH_FACE_LIST {{\n");
    for (std::size_t i = 0; i < object.triangles.size(); ++i) {
        const auto [a, b, c] = object.triangles[i];
        fmt::format_to(to,
                       "\t\t\t*MESH_FACE {}: A: {} B: {} C: {} AB: 1 BC: 1 CA: 1 *MESH_SMOOTHING 1 *MESH_MTLID {}\n", i,
                       a, b, c, mesh.triangles[object.begin + i].material);
    }
    fmt::format_to(to, "\t\t}}\n\t\t*MESH_NORMALS {{\n");
    for (std::size_t i = 0; i < object.triangles.size(); ++i) {
        const Triangle& t = mesh.triangles[object.begin + i];
        const Vec3 area = mesh.area_vector(t);
        const Vec3 face = glm::length(area) > 0 ? glm::normalize(area) : mesh.normals[t.normal[0]];
        fmt::format_to(to, "\t\t\t*MESH_FACENORMAL {}\t{}\t{}\t{}\n", i, face.x, face.y, face.z);
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 n = mesh.normals[t.normal[k]];
            fmt::format_to(to, "\t\t\t\t*MESH_VERTEXNORMAL {}\t{}\t{}\t{}\n", object.triangles[i][k], n.x, n.y, n.z);
        }
    }
    fmt::format_to(to, "\t\t}}\n\t}}\n\t*MATERIAL_REF 0\n}}\n");
}

}  // namespace

std::string encode_ase(const Mesh& mesh, const MeshNotes& notes) {
    fmt::memory_buffer out;
    const auto to = std::back_inserter(out);
    int last = 0;
    for (const Triangle& t : mesh.triangles) last = std::max(last, t.material);
    fmt::format_to(
        to,
        "*3DSMAX_ASCIIEXPORT\t200\n*COMMENT \"Deburr\"\n*MATERIAL_LIST {{\n\t*MATERIAL_COUNT 1\n\t*MATERIAL 0 {{\n");
    put_material(to, "\t\t", "materials", "Multi/Sub-Object", material_color(notes, 0));
    fmt::format_to(to, "\t\t*NUMSUBMTLS {}\n", last + 1);
    for (int m = 0; m <= last; ++m) {
        fmt::format_to(to, "\t\t*SUBMATERIAL {} {{\n", m);
        put_material(to, "\t\t\t", fmt::format("material_{}", m), "Standard", material_color(notes, m));
        fmt::format_to(to, "\t\t}}\n");
    }
    fmt::format_to(to, "\t}}\n}}\n");
    for_each_object(mesh, [&](const MeshObject& object) { put_object(to, mesh, object, notes); });
    return fmt::to_string(out);
}

}  // namespace deburr
