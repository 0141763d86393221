// Rounds of triage's refinement: which cells are polygonized again, and which results are kept.
#include "polygonizer/triage/rounds.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "catch.hpp"
#include "polygonizer/mesh/crossing_triangles.hpp"
#include "polygonizer/mesh/metrics.hpp"
#include "polygonizer/mesh/refine.hpp"
#include "polygonizer/random_part.hpp"
#include "polygonizer/triage/surface.hpp"
#include "polygonizer/triage/triage.hpp"

using namespace deburr;

namespace {

// A rounded prism of 40 sides, radius 1 and length 1 along z.
SolidTree rod(double r) {
    Density all = Density::half_space({0, 0, -1}, 0) & Density::half_space({0, 0, 1}, 1);
    constexpr int sides = 40;
    for (int k = 0; k < sides; ++k) {
        const double a = 2 * 3.14159265358979323846 * k / sides;
        all = all & Density::half_space({std::cos(a), std::sin(a), 0}, 1);
    }
    return flatten(Solid::rounded(r, all));
}

// Calls check(radius, solid, mesh, origins) for rounded random parts and their isosurfaces in an unrefined subdivision.
template <class Check>
void each_random_part(Check check) {
    for (const int seed : {1, 2, 3, 5, 8}) {
        CAPTURE(seed);
        RandomPart part(seed);
        const SolidTree solid = flatten(part.solid());
        if (part.radius() == 0) continue;
        const Subdivision subdivision(solid, polygonization_box(solid));
        Subspace subspace(subdivision);
        subspace.polygonize();
        std::vector<Origin> origins;
        const Mesh mesh = surface(subspace, solid, &origins);
        check(part.radius(), solid, mesh, origins);
    }
}

}  // namespace

TEST_CASE("Cells that are halved again and again are looked at by themselves, not with all the others") {
    for (const int seed : {0, 7, 14, 16}) {
        CAPTURE(seed);
        RandomPart part(seed);
        const SolidTree solid = flatten(part.solid());
        TriageStatistics statistics;
        const Mesh mesh = triage(solid, polygonization_box(solid), {}, &statistics);
        CHECK(statistics.rounds == 2);  // 4 or 5 if every halving polygonized all cells again
        CHECK(topology(mesh).manifold());
    }
}

TEST_CASE("Walls close the mesh of some cells, and what touches none of them is where it is in the whole mesh") {
    const SolidTree solid = rod(0.1);
    Subdivision subdivision(solid, polygonization_box(solid));
    const auto polygonized = [&](Subspace subspace, std::vector<Origin>& origins) {
        origins.clear();
        subspace.polygonize();
        return surface(subspace, solid, &origins);
    };
    std::vector<Origin> origins;
    const Mesh whole = polygonized(Subspace(subdivision), origins);
    CHECK(std::ranges::none_of(origins, [](Origin o) { return o.leaf == Origin::wall; }));

    std::size_t found = 0, walls = 0;
    const int cells = int(subdivision.complex.cells.size());
    for (int c = 0; c < cells; c += cells / 20) {
        const std::vector<int> some = subdivision.complex.with_neighbours(std::array{c});
        const Mesh part = polygonized(Subspace(subdivision, some), origins);
        if (part.triangles.empty()) continue;
        CHECK(topology(part).manifold());
        std::vector<char> on_wall(part.positions.size(), false);
        for (std::size_t t = 0; t < origins.size(); ++t)
            if (origins[t].leaf == Origin::wall) {
                ++walls;
                for (const int v : part.triangles[t].vertex) on_wall[v] = true;
            }
        for (std::size_t v = 0; v < on_wall.size(); ++v)
            if (!on_wall[v]) {
                double nearest = infinity;
                for (const Vec3& x : whole.positions) nearest = std::min(nearest, glm::length(x - part.positions[v]));
                // Where a face's segments bend is decided by the first of its two cells, which may be missing from the
                // part.
                CHECK(nearest < 1e-5);
                ++found;
            }
    }
    CHECK(found > 20);
    CHECK(walls > 100);
}

TEST_CASE("What is nearly flat in a cell stays flat within a slack") {
    const double r = 0.2, slack = 0.02 * r;
    const SolidTree solid = rod(r);
    const Subdivision subdivision(solid, polygonization_box(solid));
    Mesh fine, coarse;
    for (Mesh* mesh : {&fine, &coarse}) {
        Subspace subspace(subdivision, mesh == &fine ? 0 : slack);
        subspace.polygonize();
        *mesh = surface(subspace, solid);
        CHECK(topology(*mesh).manifold());
        CHECK(crossing_triangles(*mesh, TriangleTree(*mesh)).empty());
    }
    CHECK(10 * coarse.triangles.size() < 7 * fine.triangles.size());
    CHECK(100 * measure(coarse, solid).inverted < coarse.triangles.size());  // mended later
    CHECK(measure(coarse, solid).distance.max < measure(fine, solid).distance.max + 2 * slack);
}

TEST_CASE("Facets that were found good are known again by their corners, normals and leaves") {
    const SolidTree solid = rod(0.1);
    const Subdivision subdivision(solid, polygonization_box(solid));
    Subspace subspace(subdivision);
    subspace.polygonize();
    std::vector<Origin> origins;
    Mesh mesh = surface(subspace, solid, &origins);
    GoodFacets good;
    CHECK(!good.has(mesh, mesh.triangles[0], origins[0]));
    good.become(mesh, origins, {3, 5});
    for (std::size_t t = 0; t < origins.size(); ++t)
        CHECK(good.has(mesh, mesh.triangles[t], origins[t]) == (t != 3 && t != 5));
    CHECK(!good.has(mesh, mesh.triangles[7], {origins[7].cell, origins[7].leaf + 1}));
    mesh.positions[mesh.triangles[7].vertex[1]].x += 1e-12;
    CHECK(!good.has(mesh, mesh.triangles[7], origins[7]));
}

TEST_CASE("Triangles that took the place of such as nothing helped are not told of unless they are far") {
    each_random_part([](double radius, const SolidTree& solid, Mesh mesh, std::vector<Origin> origins) {
        const FacetJudge judge(solid, mesh);
        const double tolerance = 0.003 * radius;
        for (const int t : refine(mesh, origins, judge, tolerance))
            CHECK(!judge.is_near(mesh.corners(mesh.triangles[t]), tolerance));
    });
}

TEST_CASE("A triangle is told to be far if it is far by itself, though each edge is looked at for two triangles") {
    std::size_t found = 0;
    each_random_part([&](double radius, const SolidTree& solid, const Mesh& mesh, const std::vector<Origin>&) {
        const FacetJudge judge(solid, mesh);
        for (const double tolerance : {0.01 * radius, 0.1 * radius}) {
            std::vector<int> far{-1}, expected{-1};
            for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
                if (!judge.is_near(mesh.corners(mesh.triangles[t]), tolerance)) expected.push_back(int(t));
            CHECK(add_far(mesh, judge, tolerance, far) + 1 == expected.size());
            CHECK(far == expected);
            found += expected.size() - 1;
        }
    });
    CHECK(found > 100);
}
