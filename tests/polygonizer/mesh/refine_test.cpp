// Refinement of a mesh to a tolerance, and triangles that cross.
#include "polygonizer/mesh/refine.hpp"

#include <algorithm>

#include "catch.hpp"
#include "polygonizer/mesh/crossing_triangles.hpp"
#include "polygonizer/mesh/metrics.hpp"
#include "polygonizer/triage/surface.hpp"
#include "polygonizer/triage/triage.hpp"

using namespace deburr;

namespace {

// Two crossed boxes: convex and concave rounded edges, and corners where three edges meet.
SolidTree crossed_boxes(double r) {
    const Density upright = Density::box({-0.3, -1, -0.2}, {0.3, 1, 0.2});
    const Density tilted = Density::box({-1, -0.35, -0.4}, {1, 0.25, 0.3});
    return flatten(Solid::rounded(r, upright | tilted));
}

// Convex hull of the points: the half-spaces of all planes through three of them that have no point beyond.
Density hull(const std::vector<Vec3>& points) {
    std::vector<Density> sides;
    std::vector<Vec3> normals;
    for (const Vec3& a : points)
        for (const Vec3& b : points)
            for (const Vec3& c : points) {
                const Vec3 area = glm::cross(b - a, c - a);
                if (glm::length(area) < 1e-9) continue;
                const Vec3 n = glm::normalize(area);
                const auto near = [&](Vec3 m) { return glm::length(n - m) < 1e-9; };
                const auto beyond = [&](Vec3 x) { return glm::dot(n, x - a) > 1e-9; };
                if (std::ranges::any_of(points, beyond) || std::ranges::any_of(normals, near)) continue;
                normals.push_back(n);
                sides.push_back(Density::half_space(n, glm::dot(n, a)));
            }
    Density all = sides[0];
    for (std::size_t k = 1; k < sides.size(); ++k) all = all & sides[k];
    return all;
}

// One turn of a screw thread: overlapping convex pieces along a helix, around a core.
SolidTree thread(int pieces, double r) {
    const double step = 2 * pi / pieces;
    Density core = Density::half_space({0, 1, 0}, 1.75) & Density::half_space({0, -1, 0}, 1);
    for (int i = 0; i < pieces; ++i) {
        const double a = step * (i + 0.5);
        core = core & Density::half_space({std::cos(a), 0, std::sin(a)}, 12.7 * std::cos(0.5 * step));
    }
    Density all = core;
    for (int i = 0; i < pieces; ++i) {
        std::vector<Vec3> points;
        for (const int end : {0, 1})
            for (const auto& [out, up] : {std::pair{12.65, -0.375}, {12.65, 0.375}, {13.35, 0.1}, {13.35, -0.1}}) {
                const double a = step * (i + end), y = 0.75 * (i + end) / pieces;
                points.push_back({out * std::cos(a), y + up, out * std::sin(a)});
            }
        all = all | hull(points);
    }
    return flatten(Solid::rounded(r, all));
}

}  // namespace

TEST_CASE("Splits of edges bring a mesh within a tolerance, still closed, with its vertices on the surface") {
    const double r = 0.1;
    const SolidTree tree = crossed_boxes(r);
    const Box box = polygonization_box(tree);
    Subdivision subdivision(tree, box);
    Subspace subspace(subdivision);
    subspace.polygonize();
    std::vector<Origin> origins;
    const Mesh coarse = surface(subspace, tree, &origins);
    const FacetJudge judge(tree, coarse);
    int told = 0;  // tolerances at which some triangles remain too far
    for (const double tolerance : {0.05 * r, 0.02 * r, 0.005 * r}) {
        CAPTURE(tolerance);
        Mesh mesh = coarse;
        std::vector<Origin> of_mesh = origins;
        const std::vector<int> left = refine(mesh, of_mesh, judge, tolerance);
        CHECK(100 * left.size() <= mesh.triangles.size());
        CHECK(of_mesh.size() == mesh.triangles.size());
        CHECK(mesh.triangles.size() > coarse.triangles.size());
        const MeshMetrics m = measure(mesh, tree);
        CHECK(m.topology.manifold());
        CHECK(m.vertex_distance < 1e-9);
        if (left.empty()) CHECK(m.distance.max <= tolerance);
        told += !left.empty();
        CHECK(crossing_triangles(mesh, TriangleTree(mesh)).empty());
    }
    CHECK(told <= 1);
    CHECK(measure(coarse, tree).distance.max > 0.05 * r);  // so there was something to refine
}

TEST_CASE("Some triangles are brought within a tolerance alone, and the others stay") {
    const double r = 0.1, tolerance = 0.02 * r;
    const SolidTree tree = crossed_boxes(r);
    Subdivision subdivision(tree, polygonization_box(tree));
    Subspace subspace(subdivision);
    subspace.polygonize();
    std::vector<Origin> origins, whole_origins;
    const Mesh coarse = surface(subspace, tree, &origins);
    const FacetJudge judge(tree, coarse);
    const auto far = [&](const Mesh& mesh) {
        std::vector<int> triangles;
        for (int t = 0; t < int(mesh.triangles.size()); ++t) {
            if (!judge.is_near(mesh.corners(mesh.triangles[t]), tolerance)) triangles.push_back(t);
        }
        return triangles;
    };
    const std::vector<int> all = far(coarse);
    REQUIRE(all.size() > 20);
    whole_origins = origins;
    Mesh whole = coarse, none = coarse, some = coarse;
    REQUIRE(refine(whole, whole_origins, judge, tolerance).empty());
    std::vector<Origin> none_origins = origins, some_origins = origins;
    CHECK(refine(none, none_origins, std::vector<int>{}, judge, tolerance).empty());
    CHECK(none.triangles.size() == coarse.triangles.size());
    refine(some, some_origins, std::vector<int>(all.begin(), all.begin() + 10), judge, tolerance);
    CHECK(topology(some).manifold());
    CHECK(some.triangles.size() > coarse.triangles.size());
    CHECK(some.triangles.size() < whole.triangles.size());
    CHECK(far(some).size() < all.size());
}

TEST_CASE("Triangles that cross each other are found, each pair once") {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.2, -1}, {0.2, 0.2, 1}, {0.3, 0.4, 0}, {5, 5, 5}};
    mesh.normals = {{0, 0, 1}};
    mesh.triangles = {{{0, 1, 2}, {0, 0, 0}}, {{3, 4, 5}, {0, 0, 0}}, {{1, 6, 2}, {0, 0, 0}}};
    const auto pairs = crossing_triangles(mesh, TriangleTree(mesh));
    REQUIRE(pairs.size() == 1);
    CHECK(pairs[0] == std::pair{0, 1});
}

TEST_CASE("A thread of many pieces in one density is meshed and measured within its tolerance") {
    const double r = 0.05;
    const SolidTree tree = thread(30, r);
    const Mesh mesh = triage(tree, polygonization_box(tree), {.tolerance = 0.05 * r});
    const MeshMetrics m = measure(mesh, tree);  // prunes to each place; the whole density is too large to evaluate
    CHECK(m.topology.manifold());
    CHECK(m.inverted == 0);
    CHECK(m.distance.max <= 0.05 * r);
    CHECK(m.vertex_distance < 1e-6);
}
