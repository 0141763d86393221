// The triage mesher: exact b-reps, rounded edges, tolerances, and random solids as closed manifolds.
#include "polygonizer/triage/triage.hpp"

#include <algorithm>
#include <cstdlib>
#include <string>

#include "catch.hpp"
#include "polygonizer/mesh/metrics.hpp"
#include "polygonizer/mesh/separate_touching.hpp"
#include "polygonizer/random_solid.hpp"
#include "polygonizer/triage/cell_complex.hpp"
#include "polygonizer/triage/refinement.hpp"
#include "polygonizer/triage/subspace.hpp"
#include "polygonizer/unit_cube.hpp"
#include "polygonizer/welded.hpp"

using namespace deburr;
using namespace deburr::test;

namespace {

// A regular prism of inradius 1 along z, or, if `across`, along a direction that is parallel to no coordinate plane.
Density rod(int sides, double length, bool across) {
    const Vec3 z = across ? glm::normalize(Vec3(3, 2, 1)) : Vec3(0, 0, 1);
    const Vec3 x = glm::normalize(glm::cross(Vec3(0, 1, 0), z)), y = glm::cross(z, x);
    Density all = Density::half_space(z, length) & Density::half_space(-z, 0);
    for (int k = 0; k < sides; ++k) {
        const double a = 2 * pi * k / sides;
        all = all & Density::half_space(std::cos(a) * x + std::sin(a) * y, 1);
    }
    return all;
}

// obj4 [Lobb figures 11 and 13], clipped so that it is legal.
Solid obj4(double r) {
    return Solid::rounded(
        r, unit_cube() - Density::half_space({0, 1, 0}, 1) * Density::box({0.25, 0.8, 0.25}, {0.75, 1.8, 0.75}));
}

Mesh mesh_of(const SolidTree& tree, double tolerance = infinity) {
    return triage(tree, polygonization_box(tree), {tolerance});
}

struct MeasuredTriage {
    Mesh mesh;
    MeshMetrics metrics;
};

MeasuredTriage measured(const Solid& solid, double tolerance = infinity) {
    const SolidTree tree = flatten(solid);
    Mesh mesh = mesh_of(tree, tolerance);
    const MeshMetrics metrics = measure(mesh, tree);
    return {std::move(mesh), metrics};
}

}  // namespace

TEST_CASE("A complex stays sound under cuts, also where planes pass through vertices") {
    CellComplex complex(Box{Vec3(0.0), Vec3(1.0)}, 1e-9);
    std::mt19937 random(1);
    const Vec3 normals[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, 1, 1}, {1, -1, 0}, {2, 1, 0}};
    for (int k = 0; k < 200; ++k) {
        const Vec3 n = glm::normalize(normals[random() % 7]);
        const Vec3 through = 0.25 * Vec3(random() % 5, random() % 5, random() % 5);
        complex.cut(int(random() % complex.cells.size()), {n, glm::dot(n, through)});
    }
    CHECK(complex.cells.size() > 40);
    CHECK(complex.is_sound());
}

TEST_CASE("Triage §6.1: a smoothed cuboid's edge is two rectangles, its corner six triangles") {
    const MeasuredTriage m = measured(Solid::rounded(0.1, unit_cube()));
    CHECK(m.mesh.polygons == 6 + 12 * 2 + 8 * 6);
    CHECK(m.mesh.triangles.size() == 6 * 2 + 12 * 4 + 8 * 6);
    CHECK(m.metrics.topology.manifold());
    CHECK(m.metrics.topology.euler == 2);
    CHECK(m.metrics.inverted == 0);
    CHECK(m.metrics.vertex_distance < 1e-12);
}

TEST_CASE("Radius 0 yields the b-rep of the polyhedron") {
    CHECK(measured(Solid::sharp(unit_cube())).mesh.triangles.size() == 12);
    const MeasuredTriage m = measured(obj4(0));
    CHECK(m.mesh.polygons == 11);  // one of these faces has a hole
    CHECK(m.mesh.triangles.size() == 28);
    CHECK(m.metrics.topology.euler == 2);
    CHECK(m.metrics.volume == Approx(0.95).epsilon(1e-12));
}

TEST_CASE("Lobb's obj4: at most 1.5 % and 0.1 % of the triangles of marching cubes") {
    for (const auto& [r, most] : {std::pair{0.05, 306}, std::pair{0.01, 511}}) {
        CAPTURE(r);
        const MeasuredTriage m = measured(obj4(r));
        CHECK(m.mesh.triangles.size() <= std::size_t(most));
        CHECK(m.metrics.topology.manifold());
        CHECK(m.metrics.inverted == 0);
        CHECK(m.metrics.degenerate == 0);
        CHECK(m.metrics.vertex_distance < 1e-9);
        CHECK(m.metrics.distance.max < 0.11 * r);  // greatest in the corners, which have six triangles
    }
}

TEST_CASE("Parts that touch in an edge or a corner stay apart, each a manifold") {
    for (const Vec3 at : {Vec3(1, 1, 0), Vec3(1, 1, 1)})
        for (const double r : {0.0, 0.1}) {
            const MeasuredTriage m = measured(Solid::rounded(r, unit_cube() + Density::box(at, at + Vec3(1.0))));
            CHECK(m.metrics.topology.manifold());
            CHECK(m.metrics.topology.shells == 2);
        }
}

TEST_CASE("Flush faces of a Boolean density are one flat polygon") {
    const MeasuredTriage m =
        measured(Solid::rounded(0.05, unit_cube() | Density::box({0.5, 0.5, 0.2}, {1.5, 1.0, 0.8})));
    CHECK(m.metrics.topology.manifold());
    int on_top = 0;
    for (const Vec3& x : m.mesh.positions) {
        CHECK(x.y <= 1 + 1e-12);
        on_top += x.y == 1;
    }
    CHECK(on_top >= 4);
}

TEST_CASE("A clipped density is sharp at the clip [Triage §6.1, the punch pin]") {
    const Density pin = Density::box({0, 0, 0}, {1, 1, 2}).radius(0.1) * Density::half_space({0, 0, 1}, 1.5);
    const MeasuredTriage m = measured(Solid::sharp(pin));
    CHECK(m.metrics.topology.manifold());
    CHECK(m.metrics.vertex_distance < 1e-9);
    CHECK(m.metrics.box.hi.z == Approx(1.5).epsilon(1e-12));
}

TEST_CASE("Sharp parts of densities with round parts are leaves of their own, and cost no cells") {
    const Density rod = Density::cylinder({0, 0, -3}, {0, 0, 3}, 0.42), box = Density::box(Vec3(-1.0), Vec3(1.0));
    struct Case {
        const char* what;
        Density density;
        double volume;
    };
    const Case cases[] = {
        {"a rounded rod, clipped", rod * Density::half_space({0, 0, 1}, 1).radius(0), pi * 0.42 * 0.42 * 4},
        {"a rounded box with a sharp bore", box & ~rod.radius(0), 8 - pi * 0.42 * 0.42 * 2},
        {"a rounded box and a sharp ball", box | Density::sphere({1, 0, 0}, 0.5).radius(0), 8 + pi / 12},
        {"a rounded box and half of a sharp ring", box | Density::torus({1, 0, 0}, {1, 0, 0}, 0.6, 0.2).radius(0),
         8 + pi * pi * 0.6 * 0.04},
        {"a rounded rod in a sharp one", rod | (Density::cylinder({0, 0, -2}, {0, 0, 2}, 0.6).radius(0)),
         pi * (0.36 * 4 + 0.42 * 0.42 * 2)},
        {"a rounded box with a sharp cone's hole", box & ~Density::cone({0, 0, -1.5}, {0, 0, 1.5}, 0.5, 0.1).radius(0),
         8 - pi / 3 * 2 * (0.4333 * 0.4333 + 0.4333 * 0.1667 + 0.1667 * 0.1667)}};
    for (const auto& [what, density, volume] : cases) {
        CAPTURE(what);
        const SolidTree tree = flatten(Solid::rounded(0.1, density));
        TriageStatistics statistics;
        const Mesh mesh = triage(tree, polygonization_box(tree), {.tolerance = 0.005}, &statistics);
        const MeshMetrics m = measure(mesh, tree);
        CHECK(statistics.cells < 1000);
        CHECK(m.topology.manifold());
        CHECK(m.inverted == 0);
        CHECK(m.distance.max <= 0.005);
        CHECK(m.volume == Approx(volume).epsilon(0.03));
    }
}

TEST_CASE("A rod of many sides takes cells for its sides and not for its length, however it lies") {
    for (const bool across : {false, true}) {
        std::size_t cells = 0;
        for (const double length : {10.0, 1e4}) {
            CAPTURE(across, length);
            const SolidTree tree = flatten(Solid::rounded(0.3, rod(20, length, across)));
            TriageStatistics statistics;
            const Mesh mesh = triage(tree, polygonization_box(tree), {.tolerance = 0.015}, &statistics);
            const MeshMetrics m = measure(mesh, tree);
            CHECK(m.topology.manifold());
            CHECK(m.inverted == 0);
            CHECK(m.distance.max <= 0.015);
            if (length > 10) CHECK(statistics.cells < 10 * cells);
            cells = statistics.cells;
        }
    }
}

TEST_CASE("A solid that needs too many cells is refused, and memory stays bounded") {
    const SolidTree tree = flatten(Solid::rounded(0.3, rod(200, 3e6, true)));
    CHECK_THROWS_AS(triage(tree, polygonization_box(tree), {.tolerance = 0.015, .max_half_spaces = 100'000}),
                    TooManyCells);
}

TEST_CASE("What a sharp cut leaves on both of its sides is one surface") {
    // Each half used to have its own chords along the cut, with slivers between them, as in seed 16417.
    const Density part = unit_cube().radius(0.1), cut = Density::half_space({0, 1, 1}, 0.9);
    CHECK(measured(Solid::sharp((part & cut) | (part & ~cut))).mesh.polygons ==
          measured(Solid::sharp(part)).mesh.polygons);
    CHECK(measured(RandomSolid(16417).solid()).metrics.inverted == 0);
}

TEST_CASE("Shells of coinciding surfaces that enclose nothing are dropped") {
    // The two solids complement each other where both are rounded, and are apart elsewhere.
    const Density corner = Density::box({0.75, 0.75, 0}, {1.75, 1.25, 0.5});
    const Density rest =
        Density::box({0.5, 0.25, 0.25}, {1.5, 1.25, 1.25}) & ~Density::box({0.75, 0.75, 0.25}, {1.5, 1.25, 1.25});
    CHECK(measured(Solid::rounded(0.05, rest) & Solid::rounded(0.05, corner)).mesh.triangles.empty());
}

TEST_CASE("A filter that reaches all over an object of many half-spaces melts it, still closed [Triage §6.4]") {
    Density row = Density::box(Vec3(0.0), Vec3(1.0));
    for (int i = 1; i < 6; ++i) row = row + Density::box({double(i), 0, 0}, {i + 1.0, 1, 1});
    std::size_t gone = 0;
    for (const double r : {0.3, 0.6, 0.9, 1.5, 3.0, 9.0}) {
        CAPTURE(r);
        const SolidTree tree = flatten(Solid::rounded(r, row));
        const Mesh mesh = triage(tree, polygonization_box(tree));
        CHECK(topology(mesh).manifold());
        gone += mesh.triangles.empty();
    }
    CHECK(gone > 0);
    CHECK(gone < 5);
}

TEST_CASE("Cells follow the surface where very many half-spaces reach every place on it") {
    // A polyhedron with facets about as wide as the filter. When cells were halved until few half-spaces varied in
    // them, it took 38,000 cells.
    constexpr int count = 1000;
    std::vector<Density> faces;
    for (int i = 0; i < count; ++i) {
        const double y = 1 - (2 * i + 1.0) / count, angle = 2.399963229728653 * i, q = std::sqrt(1 - y * y);
        faces.push_back(Density::half_space({q * std::cos(angle), y, q * std::sin(angle)}, 1));
    }
    const SolidTree tree = flatten(Solid::rounded(0.05, Density::product(faces)));
    TriageStatistics statistics;
    const Mesh mesh = triage(tree, polygonization_box(tree), {0.0025}, &statistics);
    CHECK(topology(mesh).manifold());
    CHECK(statistics.cells < 4000);
}

TEST_CASE("A tolerance is met all over the mesh, still closed") {
    for (const double tolerance : {0.005, 0.001}) {
        CAPTURE(tolerance);
        const SolidTree tree = flatten(obj4(0.1));
        const Mesh mesh = mesh_of(tree, tolerance);
        CHECK(topology(mesh).manifold());
        const DistanceField field(tree, field_box(mesh));
        double farthest = 0;
        constexpr int parts = 8;
        for (const Triangle& t : mesh.triangles)
            for (int i = 0; i <= parts; ++i)
                for (int j = 0; i + j <= parts; ++j) {
                    const auto at = [&](std::size_t k) { return mesh.positions[t.vertex[k]]; };
                    const Vec3 x =
                        (at(0) * double(i) + at(1) * double(j) + at(2) * double(parts - i - j)) / double(parts);
                    farthest = std::max(farthest, field.distance_along_normal(x, 0.1));
                }
        CHECK(farthest <= tolerance);
        CHECK(farthest > 0.3 * tolerance);
    }
}

TEST_CASE("Where a filter reaches all over many half-spaces a tolerance is met too, still closed") {
    Density columns = Density::box(Vec3(0.0), {1, 1, 0.4});
    for (int k = 1; k < 9; ++k) {
        const Vec3 corner(k / 3, k % 3, 0);
        columns = columns + Density::box(corner, corner + Vec3(1, 1, 0.4 + 0.3 * ((k / 3 * 7 + k % 3 * 3) % 4)));
    }
    const MeasuredTriage m = measured(Solid::rounded(1.2, columns), 0.01);
    CHECK(topology(m.mesh).manifold());
    CHECK(m.metrics.vertex_distance < 1e-6);
}

TEST_CASE("Cells and their neighbours polygonized alone are judged as in the whole") {
    const double r = 0.1, tolerance = 0.003;
    for (const Solid& solid : {obj4(r), obj4(r) - Solid::rounded(0.05, Density::box(Vec3(-0.5), Vec3(0.5)))}) {
        const SolidTree tree = flatten(solid);
        Subdivision subdivision(tree, polygonization_box(tree));
        for (int round = 0; round < 3; ++round) {
            Subspace whole(subdivision);
            whole.polygonize();
            const std::vector<Cut> wanted = cells_to_halve(whole, tolerance);
            REQUIRE(wanted.size() > 20);
            for (std::size_t k = 0; k < wanted.size(); k += 7) {
                const std::vector<int> cells = subdivision.complex.with_neighbours(std::vector<int>{wanted[k].cell});
                Subspace part(subdivision, cells);
                CHECK(part.complex().is_sound());
                CHECK(part.complex().cells.size() < subdivision.complex.cells.size());
                part.polygonize();
                const std::vector<Cut> found = cells_to_halve(part, tolerance);
                const auto same =
                    std::find_if(found.begin(), found.end(), [&](const Cut& c) { return c.cell == wanted[k].cell; });
                REQUIRE(same != found.end());
                CHECK(same->error == Approx(wanted[k].error));
            }
            for (const Cut& cut : wanted) subdivision.halve(cut.cell, cut.plane);
        }
    }
}

TEST_CASE("Primary CSG of rounded solids is closed and sharp where the tree is") {
    const Density ball_like = Density::box({0.5, 0.5, 0.5}, {1.2, 1.3, 1.1});
    const Solid a = Solid::rounded(0.1, unit_cube()), b = Solid::rounded(0.15, ball_like);
    for (const Solid& s : {a | b, a & b, a - b, b - a}) {
        const MeasuredTriage m = measured(s);
        CHECK(m.metrics.topology.manifold());
        CHECK(m.metrics.topology.euler == 2);
        CHECK(m.metrics.vertex_distance < 1e-6);
    }
}

// DEBURR_STRESS=10000 takes 10,000 cases, in about four minutes; DEBURR_STRESS_FROM=N sets the first seed.
TEST_CASE(
    "Random CSG objects: no abort, no hole, no non-manifold edge, no facet inward, no vertex beside the surface") {
    const char* wanted = std::getenv("DEBURR_STRESS");
    const char* from = std::getenv("DEBURR_STRESS_FROM");
    const int cases = wanted ? std::atoi(wanted) : 300, first = from ? std::atoi(from) : 0;
    std::size_t triangles = 0;
    for (int seed = first; seed < first + cases; ++seed) {
        CAPTURE(seed);
        const SolidTree tree = flatten(RandomSolid(seed).solid());
        Box box = polygonization_box(tree);
        if (box.empty()) continue;
        box = intersection(box, Box{Vec3(-8.0), Vec3(8.0)});
        Mesh mesh = triage(tree, box);
        const Topology t = topology(mesh);
        CHECK(t.manifold());
        CHECK(t.euler % 2 == 0);
        CHECK(t.euler <= 2 * long(t.shells));
        CHECK(volume(mesh) > -1e-12);  // parts without thickness have a volume of ±0
        triangles += t.triangles;
        const MeshMetrics m = measure(mesh, tree);
        CHECK(m.inverted == 0);
        CHECK(m.degenerate == 0);
        CHECK(m.vertex_distance < 1e-6);
        CHECK(separate_touching(mesh) == 0);
        CHECK(topology(welded(mesh)).closed());
    }
    CHECK(triangles > 100 * std::size_t(cases));
}

TEST_CASE("Facets that leaned inward face outward: folds, slivers, walls thinner than the mesh is fine", "[slow]") {
    for (const int seed : {47,    78,    211,   285,   332,   354,   413,   448,   455,   544,   552,  584,  618,
                           659,   730,   904,   925,   962,   1162,  2356,  4446,  5342,  6502,  6714, 7346, 9824,
                           11210, 11381, 11951, 13148, 14001, 14389, 15783, 18408, 19662, 25652, 27924}) {
        CAPTURE(seed);
        const SolidTree tree = flatten(RandomSolid(seed).solid());
        const MeshMetrics m = measure(mesh_of(tree), tree);
        CHECK(m.topology.manifold());
        CHECK(m.inverted == 0);
        CHECK(m.degenerate == 0);
        CHECK(m.vertex_distance < 1e-6);
    }
}

TEST_CASE("Seams of rounded solids lie on both surfaces") {
    for (const int seed : {43, 65, 172, 348, 526, 683, 737, 844}) {
        CAPTURE(seed);
        const SolidTree tree = flatten(RandomSolid(seed).solid());
        CHECK(measure(mesh_of(tree), tree).vertex_distance < 1e-6);
    }
}
