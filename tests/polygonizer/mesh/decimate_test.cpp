// Decimation within a tolerance: the mesh stays closed and near the surface, and has few triangles where it is flat.
#include "polygonizer/mesh/decimate.hpp"

#include "catch.hpp"
#include "polygonizer/mesh/mesh_check.hpp"
#include "polygonizer/mesh/metrics.hpp"
#include "polygonizer/triage/triage.hpp"

using namespace deburr;

namespace {

Density drilled_plate() {
    Density hole = Density::half_space({0, 1, 0}, 2);
    for (int k = 0; k < 12; ++k) {
        const double a = pi * k / 6;
        const Vec3 n(std::cos(a), 0, std::sin(a));
        hole = hole & Density::half_space(n, 0.29 + glm::dot(n, Vec3(0.5, 0, 0.5)));
    }
    return Density::box({0, 0, 0}, {1, 0.3, 1}) & ~hole;
}

}  // namespace

TEST_CASE("A mesh within a tolerance is thinned out: closed, outward, near, and flat where it was") {
    const double r = 0.03, tolerance = 0.05 * r;
    const SolidTree tree = flatten(Solid::rounded(r, drilled_plate()));
    const Box box = polygonization_box(tree);
    const Mesh dense = triage(tree, box, {.tolerance = tolerance, .decimate = false});
    const Mesh mesh = triage(tree, box, {.tolerance = tolerance});
    CHECK(mesh.triangles.size() < dense.triangles.size() / 2);
    CHECK(mesh.triangles.size() < 850);
    const MeshMetrics m = measure(mesh, tree);
    CHECK(m.topology.manifold());
    CHECK(m.topology.euler == 0);
    CHECK(m.inverted == 0);
    CHECK(m.vertex_distance < 1e-9);
    CHECK(m.distance.max <= tolerance);
    MeshCheckOptions options;
    options.tolerance = tolerance;
    CHECK(check_mesh(mesh, tree, box, options).crossing.count == 0);
    // Away from the rims, the top face consists of a few large triangles in its plane.
    double flat = 0;
    for (const Triangle& t : mesh.triangles) {
        const Vec3 area = mesh.area_vector(t);
        bool in_plane = true;
        for (const int v : t.vertex) in_plane &= std::abs(mesh.positions[v].y - 0.3) < 1e-9;
        if (in_plane) flat += 0.5 * area.y;
    }
    CHECK(flat > 0.55);
    CHECK(flat < 1 - pi * 0.29 * 0.29);
}

TEST_CASE("A plate with round bores takes hardly more facets than chords of its circles and profiles do") {
    const double r = 0.05, R = 0.4, tolerance = 0.05 * r;
    constexpr int bores = 4;
    Density plate = Density::box({0, 0, 0}, {4, 0.5, 3});
    for (int k = 0; k < bores; ++k) {
        const Vec3 at(1 + 2 * (k % 2), 0, 0.8 + 1.4 * (k / 2));
        plate = plate & ~Density::cylinder(at - Vec3(0, 1, 0), at + Vec3(0, 2, 0), R);
    }
    const SolidTree tree = flatten(Solid::rounded(r, plate));
    const Mesh mesh = triage(tree, polygonization_box(tree), {.tolerance = tolerance});
    // Within a twentieth of r, the profile of a rounded edge takes three chords.
    const int profile = 3, around = int(std::ceil(pi / std::acos(1 - tolerance / R)));
    const int walls = bores * 2 * around, rims = bores * 2 * profile * 2 * around,
              faces = 2 * (bores * around + 4 + 2 * bores - 2) + 4 * 2, edges = 12 * profile * 2,
              corners = 8 * profile * profile;
    const int chordal = walls + rims + faces + edges + corners;
    CAPTURE(chordal, mesh.triangles.size());
    CHECK(mesh.triangles.size() <= 1.5 * chordal);
    CHECK(topology(mesh).manifold());
    CHECK(topology(mesh).euler == 2 - 2 * bores);
    CHECK(measure(mesh, tree).distance.max <= tolerance);
}

TEST_CASE("Creases between solids stay lines of edges when a mesh is thinned out") {
    const Solid a = Solid::rounded(0.1, Density::box(Vec3(0.0), Vec3(1.0))),
                b = Solid::rounded(0.1, Density::box({0.4, 0.4, 0.4}, {1.6, 1.6, 1.6}));
    const double tolerance = 0.005;
    for (const Solid& s : {a | b, a - b}) {
        const SolidTree tree = flatten(s);
        const Mesh mesh = triage(tree, polygonization_box(tree), {.tolerance = tolerance});
        const MeshMetrics m = measure(mesh, tree);
        CHECK(m.topology.manifold());
        CHECK(m.inverted == 0);
        CHECK(m.vertex_distance < 1e-6);
        CHECK(m.distance.max <= 1.2 * tolerance);
    }
}
