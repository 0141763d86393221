// The mesh check: what it finds in damaged meshes, and that it finds nothing in meshes of random solids.
#include "polygonizer/mesh/mesh_check.hpp"

#include <algorithm>

#include "catch.hpp"
#include "polygonizer/mesh/crossing_triangles.hpp"
#include "polygonizer/mesh/triangle_tree.hpp"
#include "polygonizer/triage/triage.hpp"
#include "random_case.hpp"

using namespace deburr;

namespace {

SolidTree slotted_plate(int slots, double radius = 0.2) {
    Density body = Density::box({0, 0, 0}, {20, 10, 2});
    for (int k = 0; k < slots; ++k) body = body & ~Density::box({2.0 + 6 * k, 2, -1}, {5.0 + 6 * k, 8, 3});
    return flatten(Solid::rounded(radius, body));
}

Mesh triage_mesh(const SolidTree& solid) { return triage(solid, polygonization_box(solid)); }

MeshCheck check(const Mesh& mesh, const SolidTree& solid) { return check_mesh(mesh, solid, polygonization_box(solid)); }

SolidTree with_piece(double r) {
    return flatten(Solid::rounded(r, Density::box(Vec3(0.0), {4, 3, 4}) | Density::box({6, 0, 1.5}, {7, 1, 2.5})));
}

Mesh of_triangles(const std::vector<Vec3>& positions, const std::vector<std::array<int, 3>>& triangles) {
    Mesh mesh;
    mesh.positions = positions;
    mesh.normals = {{0, 0, 1}};
    for (const auto& t : triangles) mesh.triangles.push_back({t, {0, 0, 0}});
    return mesh;
}

}  // namespace

TEST_CASE("A mesh of its solid passes the check, and each kind of damage is found and placed") {
    const SolidTree solid = slotted_plate(2);
    const Mesh good = triage_mesh(solid);
    const MeshCheck passed = check(good, solid);
    CHECK(passed.faults() == 0);
    CHECK(passed.facets == good.triangles.size());
    CHECK(passed.pairs > good.triangles.size());
    SECTION("a facet less") {
        Mesh mesh = good;
        mesh.triangles.pop_back();
        CHECK(check(mesh, solid).open.count == 3);
    }
    SECTION("a facet that is turned over") {
        Mesh mesh = good;
        std::swap(mesh.triangles[0].vertex[1], mesh.triangles[0].vertex[2]);
        const MeshCheck found = check(mesh, solid);
        CHECK(found.open.count == 3);
        CHECK(found.inward.count == 1);
    }
    SECTION("all inside out") {
        Mesh mesh = good;
        for (Triangle& t : mesh.triangles) std::swap(t.vertex[1], t.vertex[2]);
        const MeshCheck found = check(mesh, solid);
        CHECK(found.open.count == 0);
        CHECK(found.inward.count > good.triangles.size() / 2);
        CHECK(found.missing.count > 0);
    }
    SECTION("a vertex drawn through the other side") {
        Mesh mesh = good;
        const auto top =
            std::max_element(mesh.positions.begin(), mesh.positions.end(), [](Vec3 a, Vec3 b) { return a.z < b.z; });
        const Vec3 x = *top;
        top->z = -3;
        const MeshCheck found = check(mesh, solid);
        CHECK(found.crossing.count > 0);
        CHECK(glm::length(Vec2(found.crossing.location - x)) < 3);
    }
    SECTION("a slot that is skinned over, another one, and one too many") {
        CHECK(check(triage_mesh(slotted_plate(1)), solid).added.count > 0);
        const MeshCheck none = check(triage_mesh(slotted_plate(0)), solid);
        CHECK(none.added.count > 0);
        CHECK(none.missing.count == 0);
        CHECK(none.crossing.count == 0);
        const MeshCheck three = check(triage_mesh(slotted_plate(3)), solid);
        CHECK(three.missing.count > 0);
        CHECK(three.missing.location.x > 14);
        CHECK(three.added.count == 0);
    }
}

TEST_CASE("A part of the solid that is not in the mesh is found, beside another one and alone") {
    // A unit cube vanishes at r = 0.833; just before, it is a blob half as wide as the radius.
    for (const double r : {0.1, 0.5, 0.75}) {
        CAPTURE(r);
        const SolidTree both = with_piece(r);
        const SolidTree plate_only = flatten(Solid::rounded(r, Density::box(Vec3(0.0), {4, 3, 4})));
        const MeshCheck found = check(triage_mesh(plate_only), both);
        CHECK(found.missing.count > 0);
        CHECK(found.missing.location.x > 6);
        CHECK(found.added.count == 0);
        CHECK(check(triage_mesh(plate_only), plate_only).faults() == 0);
    }
    const SolidTree blob = flatten(Solid::rounded(0.8, Density::box(Vec3(0.0), Vec3(1.0))));
    CHECK(check({}, blob).missing.count > 0);
    CHECK(check({}, flatten(Solid::rounded(0.9, Density::box(Vec3(0.0), Vec3(1.0))))).faults() == 0);
}

TEST_CASE("Triangles cross where their insides meet, and not where they touch") {
    const auto cross = [](const std::vector<Vec3>& positions, std::array<int, 3> s, std::array<int, 3> t) {
        const Mesh mesh = of_triangles(positions, {s, t});
        const bool found = triangles_cross(mesh, mesh.triangles[0], mesh.triangles[1]);
        CHECK(found == triangles_cross(mesh, mesh.triangles[1], mesh.triangles[0]));
        return found;
    };
    const std::vector<Vec3> x{{0, 0, 0}, {4, 0, 0}, {0, 4, 0},  {1, 1, -1}, {1, 1, 1},     {3, 3, 1},   {1, 1, 0},
                              {4, 4, 0}, {2, 0, 0}, {2, -2, 0}, {4, -2, 0}, {0.5, 0.5, 0}, {0.5, 1, 0}, {1, 0.5, 0}};
    CHECK(cross(x, {0, 1, 2}, {3, 4, 5}));         // through the middle
    CHECK(cross(x, {0, 1, 2}, {0, 3, 4}));         // the same, through a corner of both
    CHECK_FALSE(cross(x, {0, 1, 2}, {6, 4, 5}));   // touches it from above with a corner
    CHECK_FALSE(cross(x, {0, 1, 2}, {0, 1, 4}));   // shares an edge
    CHECK_FALSE(cross(x, {0, 1, 2}, {2, 1, 7}));   // coplanar, beside it
    CHECK_FALSE(cross(x, {0, 1, 2}, {8, 9, 10}));  // coplanar, touching a side
    CHECK(cross(x, {0, 1, 2}, {0, 1, 7}));         // coplanar, folded over the shared edge
    CHECK(cross(x, {0, 1, 2}, {11, 13, 12}));      // coplanar, inside it
    CHECK(cross(x, {0, 1, 2}, {0, 2, 1}));         // the same triangle, reversed
}

TEST_CASE("Crossing triangles are those of all pairs, each once, in a plane that leans as well") {
    std::size_t all = 0, in_plane = 0;
    for (const auto seed : seeds(60)) {
        CAPTURE(seed);
        Gen g(seed);
        const bool flat = g.chance(0.5);
        const Vec3 u(0.6, 0.48, 0.64), v(-0.8, 0.36, 0.48), w(0, -0.8, 0.6);
        std::vector<Vec3> positions;
        for (int k = 0; k < 60; ++k)
            positions.push_back(g.between(0, 5) * u + g.between(0, 5) * v + (flat ? 0 : g.between(0, 5)) * w);
        std::vector<std::array<int, 3>> triangles;
        while (triangles.size() < 80) {
            const int a = g.below(60), b = g.below(60), c = g.below(60);
            if (a != b && b != c && c != a) triangles.push_back({a, b, c});
        }
        const Mesh mesh = of_triangles(positions, triangles);
        const TriangleTree tree(mesh);
        const double slack = touching_slack(tree.box());
        std::vector<std::pair<int, int>> pairs;
        std::size_t near = 0, looked = 0;
        for (int s = 0; s < 80; ++s)
            for (int t = s + 1; t < 80; ++t) {
                near += !intersection(tree.box(s), tree.box(t)).empty();
                if (triangles_cross(mesh, mesh.triangles[s], mesh.triangles[t], slack)) pairs.push_back({s, t});
            }
        CHECK(crossing_triangles(mesh, tree, nullptr, &looked) == pairs);
        CHECK(looked == near);
        (flat ? in_plane : all) += pairs.size();
    }
    CHECK(all > 1'000);
    CHECK(in_plane > 1'000);
}

TEST_CASE("Winding numbers tell inside and outside, and edges in the way do not matter") {
    const SolidTree solid = slotted_plate(2, 0);
    const Mesh mesh = triage_mesh(solid);
    const TriangleTree tree(mesh);
    int inside = 0;
    for (const auto seed : seeds(2'000)) {
        CAPTURE(seed);
        Gen g(seed);
        Vec3 x(g.between(-1, 21), g.between(-1, 11), g.between(-0.5, 2.5));
        // In half of the cases the point is above, below or beside a vertex.
        if (g.chance(0.5)) {
            const Vec3 corner = mesh.positions[g.below(int(mesh.positions.size()))];
            const int axis = g.below(3);
            x[axis] = corner[axis];
            x[(axis + 1) % 3] = corner[(axis + 1) % 3];
        }
        const auto winding = tree.winding(x);
        if (!winding) continue;
        ++inside;
        CHECK((*winding == 1 || *winding == 0));
        bool near = false;
        for (const HalfSpace& h : solid.leaves[0].density.half_spaces) near |= std::abs(h.distance(x)) < 1e-9;
        if (!near) CHECK((*winding == 1) == solid.contains(x));
    }
    CHECK(inside > 1'000);  // the other points lie outside or on faces
}

TEST_CASE("Parts that touch in a corner pass the check, by whatever rounding turns them") {
    for (int degrees = 0; degrees < 90; degrees += 7) {
        CAPTURE(degrees);
        const double angle = degrees / 57.29577951308232;
        Affine turn;
        turn.linear = Mat3(std::cos(angle), std::sin(angle), 0, -std::sin(angle), std::cos(angle), 0, 0, 0, 1);
        turn.shift = {50, 3, 7};
        const Density wedge = Density::box({1, -1, 0.2}, {3, 1, 0.8}) * Density::half_space({-1, 1, 0}, -1) *
                              Density::half_space({-1, -1, 0}, -1);
        const SolidTree solid =
            flatten((Solid::sharp(Density::box({0, -2, 0}, {1, 2, 1})) | Solid::sharp(wedge)).transformed(turn));
        CHECK(check(triage_mesh(solid), solid).faults() == 0);
    }
}
