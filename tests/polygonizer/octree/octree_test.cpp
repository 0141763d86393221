// The octree mesher: hard edges, tolerances, thin walls, and random solids [Vyatkin §3 to §5].
#include "polygonizer/octree/octree.hpp"

#include <cstdlib>

#include "bounds/free_form.hpp"
#include "bounds/selective_mesh_field.hpp"
#include "catch.hpp"
#include "closed_shapes.hpp"
#include "polygonizer/mesh/metrics.hpp"
#include "polygonizer/random_solid.hpp"
#include "polygonizer/triage/triage.hpp"
#include "polygonizer/unit_cube.hpp"
#include "random_free_form.hpp"

using namespace deburr;
using namespace deburr::test;

namespace {

// A rotation by no simple angle, so that edges cut cells in general position.
Affine turned() {
    Affine map;
    map.linear = Mat3(0.6, 0.8, 0, -0.8, 0.6, 0, 0, 0, 1) * Mat3(1, 0, 0, 0, 0.28, 0.96, 0, -0.96, 0.28);
    return map;
}

struct MeasuredOctree {
    Mesh mesh;
    MeshMetrics metrics;
    OctreeStatistics statistics;
};

MeasuredOctree measured(const Solid& solid, const OctreeOptions& options) {
    const SolidTree tree = flatten(solid);
    MeasuredOctree m;
    m.mesh = octree(tree, polygonization_box(tree), options, &m.statistics);
    m.metrics = measure(m.mesh, tree);
    return m;
}

void check_sound(const MeasuredOctree& m) {
    CHECK(m.metrics.topology.manifold());
    CHECK(m.metrics.inverted == 0);
    CHECK(m.metrics.degenerate == 0);
    CHECK(m.metrics.vertex_distance < 1e-9);
    CHECK(m.metrics.volume > 0);
}

}  // namespace

TEST_CASE("Radius 0: a cube comes out exact, and tilted at most for a nick of a few cells [Vyatkin §3.4]") {
    for (const double edge : {0.31, 0.1, 0.05, 0.04}) {
        CAPTURE(edge);
        const MeasuredOctree upright = measured(Solid::sharp(unit_cube()), {edge});
        check_sound(upright);
        CHECK(upright.metrics.volume == Approx(1).epsilon(1e-12));
        CHECK(upright.metrics.area == Approx(6).epsilon(1e-12));
        CHECK(upright.metrics.distance.max < 1e-12);
        const MeasuredOctree tilted = measured(Solid::sharp(unit_cube().transformed(turned())), {edge});
        check_sound(tilted);
        CHECK(tilted.metrics.topology.euler == 2);
        CHECK(tilted.metrics.volume == Approx(1).epsilon(edge > 0.3 ? 1e-3 : 5e-5));
        CHECK(tilted.metrics.distance.mean < 1e-3 * edge);
    }
}

TEST_CASE("Without hard edges a cube loses them") {
    OctreeOptions options{0.1};
    options.hard_angle = 180;
    const MeasuredOctree m = measured(Solid::sharp(unit_cube().transformed(turned())), options);
    CHECK(m.metrics.topology.manifold());
    CHECK(m.statistics.hard_points == 0);
    CHECK(m.metrics.distance.max > 0.005);
}

TEST_CASE("A hard edge has points on both surfaces, with a normal for each") {
    const Solid a = Solid::rounded(0.1, unit_cube()),
                b = Solid::rounded(0.15, Density::box({0.5, 0.5, 0.5}, {1.2, 1.3, 1.1}));
    for (const Solid& s : {a | b, a & b, a - b, b - a}) {
        const MeasuredOctree m = measured(s, {0.05});
        check_sound(m);
        CHECK(m.metrics.topology.euler == 2);
        const SolidTree first = flatten(a), second = flatten(b);
        const DistanceField in_a(first, Box{Vec3(-1.0), Vec3(2.0)}), in_b(second, Box{Vec3(-1.0), Vec3(2.0)});
        std::size_t on_both = 0;
        for (const Vec3& x : m.mesh.positions)
            on_both += std::abs(in_a.at(x).distance) < 1e-9 && std::abs(in_b.at(x).distance) < 1e-9;
        CHECK(on_both == m.statistics.hard_points);
        CHECK(on_both > 40);
        CHECK(m.mesh.normals.size() >= m.mesh.positions.size() + on_both / 2);
    }
}

TEST_CASE("Halving the cells quarters distances and quadruples triangles") {
    double distance = 0;
    std::size_t triangles = 0;
    for (const double edge : {0.04, 0.02, 0.01}) {
        const MeasuredOctree m = measured(Solid::rounded(0.2, unit_cube().transformed(turned())), {edge});
        check_sound(m);
        if (triangles) {
            CHECK(m.metrics.distance.mean < 0.3 * distance);
            CHECK(double(m.metrics.topology.triangles) == Approx(4.0 * double(triangles)).epsilon(0.05));
        }
        distance = m.metrics.distance.mean;
        triangles = m.metrics.topology.triangles;
        CHECK(m.metrics.edge_mean == Approx(edge).epsilon(0.25));
    }
}

TEST_CASE("Range tests grow with the surface, not with the volume [Vyatkin §5]") {
    std::size_t before = 0;
    for (const double edge : {0.08, 0.04, 0.02, 0.01}) {
        const MeasuredOctree m = measured(Solid::rounded(0.1, unit_cube()), {edge});
        if (before) CHECK(m.statistics.range_tests < 5 * before);
        before = m.statistics.range_tests;
    }
}

TEST_CASE("A tolerance cuts cells further where it is not met") {
    const Solid solid = Solid::rounded(0.1, unit_cube());
    OctreeOptions options{0.1};
    options.tolerance = 0.001;
    const MeasuredOctree m = measured(solid, options);
    check_sound(m);
    CHECK(m.metrics.first_order.max <= 1.1 * options.tolerance);
    CHECK(m.metrics.topology.triangles < measured(solid, {0.025}).metrics.topology.triangles);
}

TEST_CASE("A model whose radius varies is thinned out within the tolerance") {
    constexpr double radius = 0.2, tolerance = 0.05 * radius;
    const test::Shape shape = test::Shape::l_prism();
    const auto mesh = std::make_shared<const ClosedMesh>(shape.vertices, shape.triangles);
    KeptEdges kept;
    kept.edges = KeptEdges::Kind::convex;
    kept.fade = 3 * radius;
    const Solid solid = Solid::of_field(std::make_shared<SelectiveMeshField>(mesh, radius, kept));
    OctreeOptions options{0.05};
    options.tolerance = tolerance;
    const MeasuredOctree fine = measured(solid, options);
    options.decimate = true;
    const MeasuredOctree thin = measured(solid, options);
    check_sound(thin);
    CHECK(thin.metrics.distance.max <= tolerance);
    CHECK(thin.metrics.topology.triangles < fine.metrics.topology.triangles / 20);
    CHECK(thin.metrics.volume == Approx(fine.metrics.volume).epsilon(0.005));
}

TEST_CASE("Sheets that pass one cell are told apart: boxes that touch, a checkerboard") {
    for (const Vec3 at : {Vec3(1, 1, 0), Vec3(1, 1, 1)})
        for (const double r : {0.0, 0.1}) {
            const MeasuredOctree m = measured(Solid::rounded(r, unit_cube() + Density::box(at, at + Vec3(1.0))), {0.1});
            CHECK(m.metrics.topology.manifold());
            CHECK(m.metrics.vertex_distance < 1e-6);
        }
    Density all = unit_cube();
    for (const Vec3 at : {Vec3(1, 1, 0), Vec3(1, 0, 1), Vec3(0, 1, 1)}) all = all + Density::box(at, at + Vec3(1.0));
    for (const double edge : {0.3, 0.1, 0.07})
        CHECK(measured(Solid::rounded(0.2, all), {edge}).metrics.topology.manifold());
}

TEST_CASE("What leaves the box is cut off by it") {
    const SolidTree tree = flatten(Solid::rounded(0.1, Density::half_space({0, 0, 1}, 0.5)));
    const Box box{Vec3(0.0), Vec3(1.0)};
    const Mesh mesh = octree(tree, box, {0.1});
    CHECK(topology(mesh).manifold());
    CHECK(volume(mesh) == Approx(0.5).epsilon(1e-9));
}

TEST_CASE("An empty solid is an empty mesh, and too many cells are refused") {
    const SolidTree nothing = flatten(Solid::sharp(unit_cube()) - Solid::sharp(Density::box(Vec3(-1.0), Vec3(2.0))));
    CHECK(octree(nothing, Box{Vec3(-1.0), Vec3(2.0)}, {0.1}).triangles.empty());
    CHECK_THROWS_AS(octree(flatten(Solid::rounded(0.1, unit_cube())), Box{Vec3(-1.0), Vec3(2.0)}, {1e-6}),
                    std::length_error);
}

TEST_CASE("A quadric: an ellipsoid's volume, and no hard edge") {
    const Quadric q{Vec3(0.1, 0.2, 0.3), Mat3(-1, 0, 0, 0, -4, 0, 0, 0, -16), Vec3(0.0), 1};
    const MeasuredOctree m =
        measured(Solid::of_field(std::make_shared<FreeForm>(q, std::vector<Perturbation>{})), {0.02});
    check_sound(m);
    CHECK(m.metrics.topology.euler == 2);
    CHECK(m.statistics.hard_points == 0);
    CHECK(m.metrics.volume == Approx(4.0 / 3 * 3.14159265358979 / 8).epsilon(1e-3));
    CHECK(m.metrics.vertex_normal_degrees.mean < 1);
    CHECK(m.metrics.normal_degrees.mean < 3);
    CHECK(m.metrics.edge_spread < 0.35);
}

TEST_CASE("A cone has its tip and the rim of its base, with hard edges [Vyatkin figures 10 and 11]", "[slow]") {
    // x² + y² ≤ (1 − z)² is a double cone; the box ends at the tip of the lower one.
    const Quadric q = revolved({0, 0, 1, -1}, Vec3(0, 0, 1), Vec3(0, 0, 1), 1, 1);
    const Solid cone = Solid::of_field(std::make_shared<FreeForm>(q, std::vector<Perturbation>{})) &
                       Solid::sharp(Density::box({-2, -2, 0}, {2, 2, 1}));
    const auto distance_of_tip = [](const Mesh& mesh) {
        double least = infinity;
        for (const Vec3& x : mesh.positions) least = std::min(least, glm::length(x - Vec3(0, 0, 1)));
        return least;
    };
    const MeasuredOctree m = measured(cone, {0.07});
    check_sound(m);
    CHECK(m.metrics.topology.euler == 2);
    CHECK(distance_of_tip(m.mesh) < 1e-9);
    std::size_t rim = 0;
    for (const Vec3& x : m.mesh.positions) rim += std::abs(x.z) < 1e-9 && std::abs(x.x * x.x + x.y * x.y - 1) < 1e-9;
    CHECK(rim > 70);
    OctreeOptions smooth{0.07};
    smooth.hard_angle = 180;
    const MeasuredOctree without = measured(cone, smooth);
    CHECK(without.metrics.topology.manifold());
    CHECK(distance_of_tip(without.mesh) > 1e-3);
    CHECK(without.metrics.distance.max > 3 * m.metrics.distance.max);
}

TEST_CASE("Random free forms by octree: closed 2-manifolds, outward, on the surface") {
    std::size_t triangles = 0, inverted = 0, degenerate = 0;
    for (int seed = 0; seed < 60; ++seed) {
        CAPTURE(seed);
        Gen g(std::uint64_t(seed) + 1);
        Solid solid = Solid::of_field(random_free_form(g, 3 * (seed % 8)));
        const Solid block = Solid::rounded(0.1, Density::box(Vec3(-0.4), Vec3(0.3, 0.5, 0.9)));
        if (seed % 4 == 1) solid = solid - block;
        if (seed % 4 == 2) solid = solid | block;
        if (seed % 4 == 3) solid = solid & block;
        const SolidTree tree = flatten(solid & Solid::sharp(Density::box(Vec3(-1.8), Vec3(1.8))));  // to bound all
        const Mesh mesh = octree(tree, polygonization_box(tree), {0.09});
        const MeshMetrics m = measure(mesh, tree);
        CHECK(m.topology.manifold());
        CHECK(m.volume > 0);
        CHECK(m.vertex_distance < 1e-6);
        triangles += m.topology.triangles;
        inverted += m.inverted;
        degenerate += m.degenerate;
    }
    CHECK(triangles > 60'000);
    CHECK(inverted < triangles / 2000);
    CHECK(degenerate < triangles / 10000);
}

// DEBURR_STRESS=N sets the number of cases.
TEST_CASE("Random CSG objects by octree: closed 2-manifolds, outward, on the surface", "[slow]") {
    const char* wanted = std::getenv("DEBURR_STRESS");
    const int cases = wanted ? std::atoi(wanted) : 200;
    std::size_t triangles = 0, inverted = 0, degenerate = 0;
    for (int seed = 0; seed < cases; ++seed) {
        CAPTURE(seed);
        const SolidTree tree = flatten(RandomSolid(seed).solid());
        Box box = polygonization_box(tree);
        if (box.empty()) continue;
        box = intersection(box, Box{Vec3(-8.0), Vec3(8.0)});
        const Mesh mesh = octree(tree, box, {0.11});
        const MeshMetrics m = measure(mesh, tree);
        CHECK(m.topology.manifold());
        CHECK(m.volume > -1e-12);
        CHECK(m.vertex_distance < 1e-6);
        triangles += m.topology.triangles;
        inverted += m.inverted;
        degenerate += m.degenerate;
    }
    CHECK(triangles > 500 * std::size_t(cases));
    // Surfaces that are closer together than the smallest cells may cross, so that a few facets are inverted.
    CHECK(inverted < triangles / 2000);
    CHECK(degenerate < triangles / 10000);
}

TEST_CASE("Free forms thinner than a cell come out whole") {
    const auto ellipsoid = [](Vec3 radii) {
        Quadric q;
        q.k = 1;
        for (int k = 0; k < 3; ++k) q.A[k][k] = -1 / (radii[k] * radii[k]);
        return Solid::of_field(std::make_shared<FreeForm>(q, std::vector<Perturbation>{}));
    };
    // No corner of a cell is in the needle, few are in the disc, and some are in the ball's wall.
    const MeasuredOctree needle = measured(ellipsoid({1, 0.01, 0.01}), {});
    CHECK(needle.metrics.topology.manifold());
    CHECK(needle.metrics.topology.euler == 2);
    CHECK(needle.metrics.inverted == 0);
    CHECK(needle.metrics.volume == Approx(4 * pi / 3 * 1e-4).epsilon(0.3));
    const MeasuredOctree disc = measured(ellipsoid({1, 0.03, 1}), {0.06});
    CHECK(disc.metrics.topology.manifold());
    CHECK(disc.metrics.topology.euler == 2);
    const MeasuredOctree wall = measured(ellipsoid(Vec3(1.0)) - ellipsoid(Vec3(0.97)), {0.1});
    CHECK(wall.metrics.topology.manifold());
    CHECK(wall.metrics.topology.euler == 4);
    CHECK(wall.metrics.topology.shells == 2);
    CHECK(wall.metrics.inverted == 0);
}
