#include "polygonizer/mesh/export_obj.hpp"

#include <fmt/format.h>

#include <iterator>
#include <set>

#include "polygonizer/mesh/export_color.hpp"

namespace deburr {

std::string encode_obj(const Mesh& mesh, const MeshNotes& notes) {
    fmt::memory_buffer out;
    const auto to = std::back_inserter(out);
    fmt::format_to(to, "# Deburr: {} vertices, {} triangles\n", mesh.positions.size(), mesh.triangles.size());
    if (!notes.material_file.empty()) fmt::format_to(to, "mtllib {}\n", notes.material_file);
    for (const Vec3& x : mesh.positions) fmt::format_to(to, "v {} {} {}\n", x.x, x.y, x.z);
    for (const Vec3& n : mesh.normals) fmt::format_to(to, "vn {} {} {}\n", n.x, n.y, n.z);
    int solid = -1, material = -1;
    for (const Triangle& t : mesh.triangles) {
        if (t.solid != solid) fmt::format_to(to, "o {}\n", solid_name(notes, solid = t.solid));
        if (t.material != material) fmt::format_to(to, "usemtl material_{}\n", material = t.material);
        fmt::format_to(to, "f {}//{} {}//{} {}//{}\n", t.vertex[0] + 1, t.normal[0] + 1, t.vertex[1] + 1,
                       t.normal[1] + 1, t.vertex[2] + 1, t.normal[2] + 1);
    }
    return fmt::to_string(out);
}

std::string encode_mtl(const Mesh& mesh, const MeshNotes& notes) {
    std::set<int> materials;
    for (const Triangle& t : mesh.triangles) materials.insert(t.material);
    std::string out = "# Deburr\n";
    for (const int m : materials) {
        const Vec3 c = material_color(notes, m);
        // Illumination model 1: the colour without highlights.
        out += fmt::format("newmtl material_{}\nKa 0 0 0\nKd {} {} {}\nKs 0 0 0\nillum 1\n", m, c.x, c.y, c.z);
    }
    return out;
}

}  // namespace deburr
