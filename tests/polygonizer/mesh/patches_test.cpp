// Patches: local changes to a mesh are applied again to a new mesh where it has the same facets as before.
#include "polygonizer/mesh/patches.hpp"

#include <algorithm>
#include <array>

#include "catch.hpp"
#include "polygonizer/mesh/metrics.hpp"
#include "polygonizer/mesh/refine.hpp"
#include "polygonizer/mesh/repair.hpp"
#include "polygonizer/random_part.hpp"
#include "polygonizer/triage/rounds.hpp"
#include "polygonizer/triage/surface.hpp"
#include "polygonizer/triage/triage.hpp"

using namespace deburr;

namespace {

struct Meshed {
    Mesh mesh;
    std::vector<Origin> origins;
};

Meshed polygonized(const Subdivision& subdivision, const SolidTree& solid) {
    Subspace subspace(subdivision);
    subspace.polygonize();
    Meshed m;
    m.mesh = surface(subspace, solid, &m.origins);
    return m;
}

// Number of facets of m that are also in `others`.
std::size_t known(const Meshed& m, const Meshed& others) {
    GoodFacets good;
    good.become(others.mesh, others.origins, {});
    std::size_t count = 0;
    for (std::size_t t = 0; t < m.origins.size(); ++t) count += good.has(m.mesh, m.mesh.triangles[t], m.origins[t]);
    return count;
}

// An octahedron; the vertices on axis k are 2k, on the negative side, and 2k + 1.
Meshed octahedron() {
    Meshed m;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            Vec3 x(0.0);
            x[axis] = side;
            m.mesh.positions.push_back(x);
            m.mesh.normals.push_back(x);
        }
    for (const int x : {0, 1})
        for (const int y : {2, 3})
            for (const int z : {4, 5}) {
                std::array<int, 3> t{x, y, z};
                if ((x + y + z) % 2 == 0) std::swap(t[0], t[1]);
                m.mesh.triangles.push_back({t, t});
                m.origins.push_back({0, 0});
            }
    return m;
}

// Flips the edge between the vertices a and b and records the change in `patches`.
void flip(Meshed& m, int a, int b, Patches* patches = nullptr) {
    Facets facets(m.mesh, m.origins, patches);
    const int f = facets.across(b, a);
    const auto change = facets.flip(f, std::size_t(facets.corner_index(f, a)));
    REQUIRE(change);
    facets.apply(*change);
    facets.finish();
}

}  // namespace

TEST_CASE("What became of patches is put in where the same facets come again, and the rest stays as it comes") {
    std::size_t kept = 0, all = 0;
    for (const int seed : {0, 1, 2, 3, 5, 8, 13}) {
        CAPTURE(seed);
        RandomPart part(seed);
        const SolidTree solid = flatten(part.solid());
        if (part.radius() == 0) continue;
        Subdivision subdivision(solid, polygonization_box(solid));
        const Meshed coarse = polygonized(subdivision, solid);
        const FacetJudge judge(solid, coarse.mesh);
        const double tolerance = 0.05 * part.radius();
        Meshed refined = coarse;
        Patches patches(refined.mesh, refined.origins);
        const std::vector<int> left =
            refine(refined.mesh, refined.origins, judge, tolerance, nullptr, nullptr, &patches);
        wrong_before_decimation(refined.mesh, refined.origins, judge, tolerance, left, nullptr, nullptr, &patches);
        CHECK(refined.mesh.triangles.size() > coarse.mesh.triangles.size());

        Meshed again = coarse;
        Patches of_again =
            patches.put_into(again.mesh, again.origins, refined.mesh, refined.origins, std::array<int, 0>{});
        CHECK(again.mesh.triangles.size() == refined.mesh.triangles.size());
        CHECK(known(again, refined) == refined.mesh.triangles.size());
        CHECK(topology(again.mesh).manifold());

        // A few cells are halved in each round; the second round starts from patches that were themselves put in.
        for (int round = 0; round < 2; ++round) {
            std::vector<Cut> cuts;
            for (std::size_t t = std::size_t(round); t < coarse.origins.size() && cuts.size() < 3; t += 40)
                if (const int c = coarse.origins[t].cell; c >= 0) cuts.push_back({c, 0, {}});
            halve_all(subdivision, cuts);
            const Meshed fresh = polygonized(subdivision, solid);
            Meshed mixed = fresh;
            Patches of_mixed =
                of_again.put_into(mixed.mesh, mixed.origins, again.mesh, again.origins, std::array<int, 0>{});
            CHECK(topology(mixed.mesh).manifold());
            const std::size_t old = known(mixed, again);
            kept += old;
            all += mixed.mesh.triangles.size();
            CHECK(old + known(mixed, fresh) >= mixed.mesh.triangles.size());
            refine(mixed.mesh, mixed.origins, judge, tolerance, nullptr, nullptr, &of_mixed);
            CHECK(topology(mixed.mesh).manifold());
            again = std::move(mixed);
            of_again = std::move(of_mixed);
        }
    }
    CHECK(10 * kept > 7 * all);
    CHECK(kept < all);
}

TEST_CASE("Patches that hold what is wrong are not put in") {
    const Meshed first = octahedron();
    Meshed flipped = first;
    Patches patches(flipped.mesh, flipped.origins);
    flip(flipped, 1, 3, &patches);
    for (int t = 0; t < int(flipped.origins.size()); ++t) {
        Meshed again = first;
        patches.put_into(again.mesh, again.origins, flipped.mesh, flipped.origins, std::array{t});
        // True if facet t has the new edge, which joins the two vertices on the last axis.
        const bool came = std::ranges::count_if(flipped.mesh.triangles[t].vertex,
                                                [&](int v) { return flipped.mesh.positions[v].z != 0; }) == 2;
        CHECK(known(again, first) == (came ? 8 : 6));
        CHECK(topology(again.mesh).manifold());
    }
}

TEST_CASE("A patch whose new edge is there already is not put in") {
    Meshed mesh = octahedron();
    Patches patches(mesh.mesh, mesh.origins);
    flip(mesh, 1, 3, &patches);  // joins 4 and 5
    Meshed fresh = octahedron();
    flip(fresh, 0, 2);  // joins 4 and 5 here as well
    const Meshed before = fresh;
    patches.put_into(fresh.mesh, fresh.origins, mesh.mesh, mesh.origins, std::array<int, 0>{});
    CHECK(topology(fresh.mesh).manifold());
    CHECK(known(fresh, before) == 8);
}

TEST_CASE("A vertex that moved is where it went, and all around it are one patch") {
    const Meshed first = octahedron();
    Meshed moved = first;
    Patches patches(moved.mesh, moved.origins);
    Facets facets(moved.mesh, moved.origins, &patches);
    facets.move(5, {0.1, 0, 1.2});
    facets.finish();
    Meshed again = first;
    patches.put_into(again.mesh, again.origins, moved.mesh, moved.origins, std::array<int, 0>{});
    CHECK(known(again, moved) == 8);

    Meshed other = first;
    flip(other, 1, 3);  // takes two facets that were around vertex 5
    const Meshed before = other;
    patches.put_into(other.mesh, other.origins, moved.mesh, moved.origins, std::array<int, 0>{});
    CHECK(known(other, before) == 8);
}
