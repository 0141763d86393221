// Facets that cross or face inward are untangled by collapses and flips of edges.
#include "polygonizer/mesh/untangle.hpp"

#include <map>
#include <tuple>

#include "catch.hpp"
#include "polygonizer/mesh/crossing_triangles.hpp"

using namespace deburr;

namespace {

constexpr int n = 8;  // squares along each edge of the cube

// The surface of the unit cube in squares, n × n on each face; faces share the vertices between them.
Mesh cube() {
    Mesh mesh;
    std::map<std::tuple<int, int, int>, int> vertices;
    for (int axis = 0; axis < 3; ++axis)
        for (const int side : {0, n}) {
            const int normal = int(mesh.normals.size());
            Vec3 outward(0.0);
            outward[axis] = side > 0 ? 1 : -1;
            mesh.normals.push_back(outward);
            const auto vertex = [&](int i, int k) {
                int at[3];
                at[axis] = side;
                at[(axis + 1) % 3] = i;
                at[(axis + 2) % 3] = k;
                const auto [known, is_new] = vertices.try_emplace({at[0], at[1], at[2]}, int(mesh.positions.size()));
                if (is_new) mesh.positions.push_back(Vec3(at[0], at[1], at[2]) / double(n));
                return known->second;
            };
            const auto add = [&](int a, int b, int c) {
                if (side == 0) std::swap(b, c);
                mesh.triangles.push_back({{a, b, c}, {normal, normal, normal}});
            };
            for (int i = 0; i < n; ++i)
                for (int k = 0; k < n; ++k) {
                    add(vertex(i, k), vertex(i + 1, k), vertex(i + 1, k + 1));
                    add(vertex(i, k), vertex(i + 1, k + 1), vertex(i, k + 1));
                }
        }
    return mesh;
}

int vertex_at(const Mesh& mesh, Vec3 x) {
    for (int v = 0; v < int(mesh.positions.size()); ++v)
        if (glm::length(mesh.positions[std::size_t(v)] - x) < 1e-9) return v;
    return -1;
}

// The mesh with its facets that face inward or cross others marked as wrong.
MendedMesh with_faults(Mesh mesh) {
    MendedMesh m;
    m.origins.resize(mesh.triangles.size());
    m.mesh = std::move(mesh);
    m.others = add_crossing(m.mesh, m.wrong);
    return m;
}

}  // namespace

TEST_CASE("a vertex that was pulled over its neighbours is untangled, and the mesh stays closed and near") {
    const SolidTree solid = flatten(Solid::sharp(Density::box(Vec3(0.0), Vec3(1.0))));
    int tangled = 0;
    for (const Vec3 to : {Vec3(0.8, 0.5, 1), Vec3(0.55, 0.7, 1), Vec3(0.2, 0.2, 1), Vec3(0.7, 0.35, 1)}) {
        Mesh mesh = cube();
        mesh.positions[std::size_t(vertex_at(mesh, Vec3(0.5, 0.5, 1)))] = to;
        MendedMesh m = with_faults(std::move(mesh));
        tangled += m.others > 0;
        const FacetJudge judge(solid, m.mesh);
        CHECK(untangle(m, judge, 0.05, nullptr) > 0);
        CHECK(m.is_right());
        CHECK(topology(m.mesh).manifold());
        CHECK(topology(m.mesh).euler == 2);
        CHECK(crossing_triangles(m.mesh, TriangleTree(m.mesh)).empty());
        double volume = 0;
        for (const Triangle& t : m.mesh.triangles)
            volume += glm::dot(m.mesh.area_vector(t), m.mesh.positions[std::size_t(t.vertex[0])]) / 6;
        CHECK(std::abs(volume - 1) < 0.002);
    }
    CHECK(tangled == 4);
}

TEST_CASE("what could be untangled only farther from the surface than allowed stays tangled", "[slow]") {
    const SolidTree solid = flatten(Solid::sharp(Density::box(Vec3(0.0), Vec3(1.0))));
    Mesh mesh = cube();
    // The points of the middle of the top are pushed through the bottom.
    for (Vec3& x : mesh.positions)
        if (x.z == 1 && x.x > 0.2 && x.x < 0.8 && x.y > 0.2 && x.y < 0.8) x.z = -0.5;
    MendedMesh m = with_faults(mesh);
    REQUIRE(m.others > 0);
    untangle(m, FacetJudge(solid, m.mesh), 1e-6, nullptr);
    CHECK_FALSE(m.is_right());
    CHECK(topology(m.mesh).manifold());
}
