// Random mechanical parts meshed by every method must pass the mesh check of the mesh command.
#include <cstdlib>

#include "bounds/bounding_box.hpp"
#include "catch.hpp"
#include "polygonizer/marching_cubes/marching_cubes.hpp"
#include "polygonizer/mesh/mesh_check.hpp"
#include "polygonizer/octree/octree.hpp"
#include "polygonizer/random_part.hpp"
#include "polygonizer/random_round_part.hpp"
#include "polygonizer/random_slanted_part.hpp"
#include "polygonizer/triage/triage.hpp"

using namespace deburr;

namespace {

// The mesh check's result for the part of this seed.
template <class Part = RandomPart, class Polygonize>
MeshCheck check_part(int seed, Polygonize polygonize) {
    Part part(seed);
    const SolidTree solid = flatten(part.solid());
    const Box box = polygonization_box(solid);
    MeshCheckOptions options;
    const Mesh mesh = polygonize(solid, box, options);
    return check_mesh(mesh, solid, box, options);
}

// Checks `usual` parts; DEBURR_STRESS=N sets their number and DEBURR_STRESS_FROM=N the first seed. With `facets_lean`
// one facet in 2000 may face inward, as happens where a wall is thinner than a cell. Returns the number of facets.
template <class Part = RandomPart, class Polygonize>
std::size_t check_parts(int usual, bool facets_lean, Polygonize polygonize) {
    const char* wanted = std::getenv("DEBURR_STRESS");
    const char* from = std::getenv("DEBURR_STRESS_FROM");
    const int cases = wanted ? std::atoi(wanted) : usual, first = from ? std::atoi(from) : 0;
    std::size_t facets = 0, inward = 0;
    for (int seed = first; seed < first + cases; ++seed) {
        CAPTURE(seed);
        const MeshCheck check = check_part<Part>(seed, polygonize);
        CHECK(check.open.count == 0);
        inward += check.inward.count;
        if (!facets_lean) CHECK(check.inward.count == 0);
        CHECK(check.crossing.count == 0);
        CHECK(check.missing.count == 0);
        CHECK(check.added.count == 0);
        facets += check.facets;
    }
    CHECK(inward <= facets / 2000);
    return facets;
}

}  // namespace

TEST_CASE("Random parts by triage pass the check of what was made") {
    CHECK(check_parts(100, false, [](const SolidTree& solid, const Box& box, MeshCheckOptions&) {
              return triage(solid, box);
          }) > 10'000);
}

namespace {

Mesh triage_of_tolerance(const SolidTree& solid, const Box& box, MeshCheckOptions& options) {
    const double radius = solid.min_radius(), tolerance = radius > 0 ? 0.05 * radius : infinity;
    options.tolerance = 2 * tolerance;
    return triage(solid, box, {tolerance});
}

}  // namespace

TEST_CASE("Random parts by triage within a tolerance pass the check of what was made") {
    CHECK(check_parts(100, false, triage_of_tolerance) > 10'000);
}

TEST_CASE("Sheets that lie in one plane and part along a curve do not cross by triage") {
    // In this part the flat bottom of a boss lies on the floor of a bore whose edges are rounded.
    constexpr int seed = 742;
    const auto coarse = [](const SolidTree& solid, const Box& box, MeshCheckOptions&) { return triage(solid, box); };
    CHECK(check_part(seed, coarse).faults() == 0);
    CHECK(check_part(seed, triage_of_tolerance).faults() == 0);
}

TEST_CASE("Random round parts by triage pass the check of what was made") {
    CHECK(check_parts<RandomRoundPart>(12, false, triage_of_tolerance) > 10'000);
}

TEST_CASE("Four chords of one sheet of a round part are no part of the mesh") {
    for (const int seed : {60, 174}) {
        CAPTURE(seed);
        CHECK(check_part<RandomRoundPart>(seed, triage_of_tolerance).inward.count == 0);
    }
}

namespace {

Mesh marching_cubes_of_50(const SolidTree& solid, const Box& box, MeshCheckOptions& options) {
    options.min_tolerance = largest(box.hi - box.lo) / 50;
    options.may_lean = true;
    return marching_cubes(solid, box, options.min_tolerance);
}

}  // namespace

TEST_CASE("Random parts by marching cubes pass the check of what was made") {
    CHECK(check_parts(20, true, marching_cubes_of_50) > 10'000);
}

TEST_CASE("Marching cubes: a point in the middle of a loop stays in its cube, so that facets do not cross") {
    for (const int seed : {256, 260}) {
        CAPTURE(seed);
        CHECK(check_part(seed, marching_cubes_of_50).faults() == 0);
    }
}

namespace {

Mesh octree_of_40(const SolidTree& solid, const Box& box, MeshCheckOptions& options) {
    OctreeOptions of_octree;
    of_octree.edge = options.min_tolerance = largest(box.hi - box.lo) / 40;
    return octree(solid, box, of_octree);
}

}  // namespace

TEST_CASE("Random parts by the octree pass the check of what was made") {
    CHECK(check_parts(10, true, octree_of_40) > 10'000);
}

TEST_CASE("The octree cuts cells further where the sides of a thin wall cross each other") {
    // In these parts no facet faced inward, so that only crossings asked for smaller cells.
    for (const int seed : {1015, 1027, 1041, 1058, 127}) {
        CAPTURE(seed);
        CHECK(check_part(seed, octree_of_40).crossing.count == 0);
    }
}

TEST_CASE("The octree cuts cells further until sharp walls part, however thin", "[slow]") {
    for (const int seed : {66, 341}) {
        CAPTURE(seed);
        CHECK(check_part(seed, octree_of_40).crossing.count == 0);
    }
}

TEST_CASE("Facets of the octree that cross at any size of its cells are untangled", "[slow]") {
    for (const int seed : {266, 353}) {
        CAPTURE(seed);
        CHECK(check_part(seed, octree_of_40).faults() == 0);
    }
    CHECK(check_part<RandomSlantedPart>(48, octree_of_40).faults() == 0);
    CHECK(check_part<RandomSlantedPart>(70, octree_of_40).crossing.count == 0);
}

TEST_CASE("Random parts with sharp round tools by the octree pass the check of what was made") {
    CHECK(check_parts<RandomSlantedPart>(10, true, octree_of_40) > 10'000);
}

TEST_CASE("The octree's facets of three points of a seam in a plane go to the plane") {
    for (const int seed : {12, 14, 18, 25, 37}) {
        CAPTURE(seed);
        CHECK(check_part<RandomSlantedPart>(seed, octree_of_40).faults() == 0);
    }
}
