// Models of several shells that overlap, touch, contain each other or cross themselves become one solid of the right
// volume, or are refused.
#include <bitset>

#include "catch.hpp"
#include "closed_shapes.hpp"
#include "polygonizer/mesh/crossing_triangles.hpp"
#include "raytracer/model/closed_surface.hpp"
#include "raytracer/text.hpp"

using namespace deburr;
using test::has;
using test::Shape;

namespace {

Shape turned(Shape s) {
    for (auto& t : s.triangles) std::swap(t[1], t[2]);
    return s;
}

ClosedSurface united(const Shape& s) { return closed_surface({s.vertices, s.triangles}); }

std::string why_unsound(const Shape& s) {
    try {
        united(s);
    } catch (const UnsoundSurface& error) {
        return error.what();
    }
    return "none";
}

std::size_t crossings(const ClosedMesh& closed) {
    Mesh mesh;
    mesh.positions = closed.vertices();
    for (const auto& t : closed.triangles()) mesh.triangles.push_back({t, {0, 0, 0}});
    return crossing_triangles(mesh, TriangleTree(mesh)).size();
}

// A prism over a polygon that may cross itself; its ends are fans around the origin.
Shape fan_prism(const std::vector<Vec2>& outline) {
    Shape s;
    const int n = int(outline.size());
    for (const double z : {0.0, 1.0}) {
        for (const Vec2 p : outline) s.vertices.push_back({p.x, p.y, z});
        s.vertices.push_back({0, 0, z});
    }
    for (int i = 0; i < n; ++i) {
        const int j = (i + 1) % n, up = n + 1;
        s.triangles.push_back({n, j, i});
        s.triangles.push_back({up + n, up + i, up + j});
        s.triangles.push_back({i, j, up + j});
        s.triangles.push_back({i, up + j, up + i});
    }
    return s;
}

}  // namespace

TEST_CASE("two boxes that overlap, or touch in a part of a face, are one solid") {
    const Shape a = Shape::box({0, 0, 0}, {10, 10, 10});
    struct Case {
        Vec3 lo, hi;
        double volume;
        std::size_t faces;
    };
    const Case cases[] = {
        {{6, 6, 6}, {16, 16, 16}, 1936, 12},         // a corner of each in the other
        {{0, 0, 5}, {10, 10, 15}, 1500, 6},          // four flush faces
        {{10, 2, 2}, {12, 8, 8}, 1072, 11},          // parts of two faces touch
        {{10, 0, 0}, {12, 10, 10}, 1200, 6},         // two whole faces touch
        {{0, 0, 0}, {10, 10, 15}, 1500, 6},          // a common face with one orientation
        {{-2, 4, 4}, {12, 6, 6}, 1016, 16},          // a bar all the way through
        {{4, 4, -1}, {14, 14, 11}, 1000 + 840, 12},  // an edge through two faces
    };
    for (const Case& c : cases) {
        CAPTURE(c.volume);
        const ClosedSurface s = united(together(a, Shape::box(c.lo, c.hi)));
        CHECK(s.mesh->volume() == Approx(c.volume).epsilon(1e-14));
        CHECK(s.mesh->planes() == c.faces);
        CHECK(crossings(*s.mesh) == 0);
    }
    const ClosedSurface said = united(together(a, Shape::box({6, 6, 6}, {16, 16, 16})));
    REQUIRE(said.mended.size() == 1);
    CHECK(said.mended[0] == "united 2 shells that overlap, where 6 pairs of facets crossed");
}

TEST_CASE("a hundred random boxes, flush or turned by any angle, have the volume of their union", "[slow]") {
    constexpr int size = 50;
    int turned_and_united = 0;
    for (auto seed : seeds(4)) {
        CAPTURE(seed);
        Gen g(seed);
        using Cells = std::bitset<size * size * size>;
        const auto cells = std::make_unique<Cells>(), few_cells = std::make_unique<Cells>();
        Shape all, few;
        constexpr int few_boxes = 12;
        for (int box = 0; box < 100; ++box) {
            int lo[3], hi[3];
            for (int k = 0; k < 3; ++k) {
                lo[k] = g.below(size - 19);
                hi[k] = lo[k] + 3 + g.below(17);
            }
            for (int x = lo[0]; x < hi[0]; ++x)
                for (int y = lo[1]; y < hi[1]; ++y)
                    for (int z = lo[2]; z < hi[2]; ++z) {
                        cells->set(std::size_t((x * size + y) * size + z));
                        if (box < few_boxes) few_cells->set(std::size_t((x * size + y) * size + z));
                    }
            const Shape one = Shape::box({lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]});
            all = together(all, one);
            if (box < few_boxes) few = together(few, one);
        }
        const ClosedSurface s = united(all);
        CHECK(std::abs(s.mesh->volume() / double(cells->count()) - 1) < 1e-13);
        CHECK(crossings(*s.mesh) == 0);
        // Rotated and rounded to floats, flush faces overlap or separate by that rounding. If the slivers between them
        // cannot be rounded without crossing, the model is refused.
        few.rotate(g);
        for (Vec3& v : few.vertices) v = Vec3(glm::vec3(v));
        try {
            const ClosedSurface t = united(few);
            CHECK(std::abs(t.mesh->volume() / double(few_cells->count()) - 1) < 1e-5);
            CHECK(crossings(*t.mesh) == 0);
            ++turned_and_united;
        } catch (const UnsoundSurface& error) {
            CHECK(has(error.what(), "expected bodies that can be united"));
        }
    }
    CHECK(turned_and_united >= 2);
}

TEST_CASE("a hundred boxes, each turned by an angle of its own, are united") {
    for (auto seed : seeds(2)) {
        CAPTURE(seed);
        Gen g(seed);
        Shape all;
        double sum = 0;
        for (int k = 0; k < 100; ++k) {
            const Vec3 half(g.between(0.1, 0.5), g.between(0.1, 0.5), g.between(0.1, 0.5));
            Shape box = Shape::box(-half, half);
            box.rotate(g);
            const Vec3 to = g.point(1.5);
            for (Vec3& v : box.vertices) v = Vec3(glm::vec3(v + to));
            sum += box.mesh().volume();
            all = together(all, box);
        }
        const ClosedSurface s = united(all);
        CHECK(crossings(*s.mesh) == 0);
        // A random point is inside the union exactly where the winding number of all boxes is positive. The volume of
        // the boxes before the union is the sum of theirs, with overlaps counted again.
        const ClosedMesh once(all.vertices, all.triangles);
        CHECK(once.volume() == Approx(sum));
        CHECK(s.mesh->volume() < sum);
        int in = 0;
        constexpr int points = 4'000;
        Mesh soup;
        soup.positions = all.vertices;
        for (const auto& t : all.triangles) soup.triangles.push_back({t, {0, 0, 0}});
        const TriangleTree tree(soup);
        for (int k = 0; k < points; ++k) {
            const Vec3 x = g.point(2.4);
            const auto winding = tree.winding(x);
            if (!winding) continue;
            in += *winding > 0;
            CHECK(s.mesh->contains(x) == (*winding > 0));
        }
        CHECK(in > points / 20);
    }
}

TEST_CASE("tessellated spheres that overlap have the volume of their union") {
    const Shape ball = Shape::sphere(1, 24);
    const double one = ball.mesh().volume();
    Shape moved = ball;
    for (Vec3& v : moved.vertices) v += Vec3(0.9, 0.05, 0.02);
    const ClosedSurface s = united(together(ball, moved));
    const double d = glm::length(Vec3(0.9, 0.05, 0.02)), lens = pi * (4 + d) * (2 - d) * (2 - d) / 12;
    CHECK(std::abs(s.mesh->volume() - (2 * one - lens)) < 0.02);
    CHECK(crossings(*s.mesh) == 0);
}

TEST_CASE("shells within shells that overlap: what any of them holds is solid") {
    const Shape a = Shape::box({0, 0, 0}, {10, 10, 10}), b = Shape::box({8, 0, 0}, {18, 10, 10});
    const Shape cavity = turned(Shape::box({1, 1, 1}, {9, 9, 9}));
    // The second body fills the part of the first body's cavity that it overlaps.
    CHECK(united(together(together(a, cavity), b)).mesh->volume() == 1800 - 7 * 8 * 8);
    // A body within both of the others adds nothing.
    CHECK(united(together(together(a, b), Shape::box({8.5, 4, 4}, {9.5, 5, 5}))).mesh->volume() == 1800);
    // All shells are inside out.
    CHECK(united(turned(together(a, b))).mesh->volume() == 1800);
}

TEST_CASE("a shell that crosses itself is what it winds around, if it is nowhere inside out") {
    std::vector<Vec2> star;
    for (int k = 0; k < 5; ++k) star.push_back({std::cos(0.8 * pi * k), std::sin(0.8 * pi * k)});
    const ClosedSurface s = united(fan_prism(star));
    // The pentagram consists of ten triangles, each with its center, a tip and an inner corner.
    const double inner = std::cos(0.4 * pi) / std::cos(0.2 * pi);
    CHECK(s.mesh->volume() == Approx(5 * inner * std::sin(0.2 * pi)).epsilon(1e-12));
    CHECK(s.mesh->planes() == 12);
    CHECK(has(s.mended.at(0), "crosses itself"));

    const std::string bow_tie = why_unsound(fan_prism({{-2, -1}, {2, 1}, {2, -1.5}, {-2, 1}}));
    CHECK(has(bow_tie, "pairs of facets that cross and "));
    CHECK(has(bow_tie, "inside out, one near {"));
    CHECK(has(bow_tie, "repair it"));
}

TEST_CASE("a body that faces inward and overlaps another is refused: it may be a hole") {
    const Shape a = Shape::box({0, 0, 0}, {10, 10, 10}), hole = turned(Shape::box({2, 2, 2}, {7, 7, 12}));
    const std::string said = why_unsound(together(a, hole));
    CAPTURE(said);
    CHECK(has(said, "expected bodies that face outward where they overlap, got "));
    CHECK(has(said, "near {"));
    CHECK(has(said, "subtract it there if it is a hole"));
}
