// Triangulation of polygons with holes, of loops that touch or cross, and the exact orientation test.
#include "polygonizer/mesh/polygon_triangles.hpp"

#include <chrono>
#include <map>

#include "catch.hpp"
#include "polygonizer/mesh/exact_orientation.hpp"
#include "polygonizer/mesh/loop_ears.hpp"
#include "random_case.hpp"

using namespace deburr;

namespace {

struct Polygon {
    std::vector<Vec3> positions;
    std::vector<std::vector<int>> loops;

    void add_loop(const std::vector<Vec2>& points) {
        loops.emplace_back();
        for (const Vec2& x : points) {
            loops.back().push_back(int(positions.size()));
            positions.push_back({x, 0.0});
        }
    }
    std::size_t corners() const {
        std::size_t n = 0;
        for (const auto& loop : loops) n += loop.size();
        return n;
    }
    double area() const {
        double sum = 0;
        for (const auto& loop : loops)
            for (std::size_t k = 0; k < loop.size(); ++k) {
                const Vec3 a = positions[loop[k]], b = positions[loop[(k + 1) % loop.size()]];
                sum += 0.5 * (a.x * b.y - a.y * b.x);
            }
        return sum;
    }
};

std::vector<Vec2> ring(Vec2 middle, double radius, int sides, bool hole, double turn = 0) {
    std::vector<Vec2> points;
    for (int k = 0; k < sides; ++k) {
        const double angle = turn + (hole ? -2 : 2) * pi * k / sides;
        points.push_back(middle + radius * Vec2(std::cos(angle), std::sin(angle)));
    }
    return points;
}

struct Faults {
    int lost_sides = 0;  // edges of the rim that are not in exactly one triangle
    int open_edges = 0;  // other edges that are not in two triangles, once in each direction
    int unbalanced = 0;  // edges used more often in one direction than in the other, rim included
    int inverted = 0;    // triangles of the wrong orientation
    int flat = 0;        // triangles without area
    double area = 0;
};

Faults faults(const Polygon& polygon, const std::vector<std::array<int, 3>>& triangles) {
    Faults f;
    std::map<std::pair<int, int>, int> uses;
    for (const auto& loop : polygon.loops)
        for (std::size_t k = 0; k < loop.size(); ++k) --uses[{loop[k], loop[(k + 1) % loop.size()]}];
    const auto rim = uses;
    const auto flat = [&](int v) { return Vec2(polygon.positions[v]); };
    for (const auto& t : triangles) {
        const double twice = orientation(flat(t[0]), flat(t[1]), flat(t[2]));
        f.inverted += twice < 0;
        f.flat += twice == 0;
        f.area += 0.5 * twice;
        for (std::size_t k = 0; k < 3; ++k) ++uses[{t[k], t[(k + 1) % 3]}];
    }
    for (const auto& [edge, count] : uses) {
        const auto other = uses.find({edge.second, edge.first});
        f.unbalanced += count != (other == uses.end() ? 0 : other->second);
        if (rim.count(edge)) {
            f.lost_sides += count != 0;
            continue;
        }
        const auto back = uses.find({edge.second, edge.first});
        f.open_edges += count != 1 || back == uses.end() || back->second != 1;
    }
    return f;
}

void check_clean(const Polygon& polygon, bool touches = false) {
    const PolygonTriangles result = triangulate(polygon.loops, polygon.positions, {0, 0, 1});
    const Faults f = faults(polygon, result.triangles);
    CHECK(f.lost_sides == 0);
    CHECK(f.open_edges == 0);
    CHECK(f.inverted == 0);
    CHECK(!result.crosses_itself);
    CHECK(f.area == Approx(polygon.area()).epsilon(1e-12));
    if (touches) return;
    CHECK(f.flat == 0);
    CHECK(result.triangles.size() == polygon.corners() - 2 + 2 * (polygon.loops.size() - 1));
}

// The outline of a random set of squares of a grid that are connected by sides, with the squares' corners moved.
// Squares that meet only in a corner make the outline touch itself, or two loops touch each other, in that corner.
Polygon of_squares(Gen& g, int size, double share, double moved, bool shared_corners) {
    std::vector<std::vector<char>> full(std::size_t(size + 2), std::vector<char>(std::size_t(size + 2), false));
    const auto at = [&](int x, int y) -> char& { return full[x + 1][y + 1]; };
    for (int x = 0; x < size; ++x)
        for (int y = 0; y < size; ++y) at(x, y) = g.chance(share);
    std::vector<std::pair<int, int>> reached{{size / 2, size / 2}};
    at(size / 2, size / 2) = 2;
    for (std::size_t k = 0; k < reached.size(); ++k)
        for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
            const int x = reached[k].first + dx, y = reached[k].second + dy;
            if (at(x, y) != 1) continue;
            at(x, y) = 2;
            reached.push_back({x, y});
        }
    std::map<std::pair<int, int>, Vec2> places;
    const auto place = [&](std::pair<int, int> c) {
        const auto [found, fresh] = places.try_emplace(c);
        if (fresh) found->second = Vec2(c.first, c.second) + moved * Vec2(g.between(-1, 1), g.between(-1, 1));
        return found->second;
    };
    // `sides` maps each corner to the ends of the sides that leave it, with the interior on their left.
    std::map<std::pair<int, int>, std::vector<std::pair<int, int>>> sides;
    for (int x = 0; x < size; ++x)
        for (int y = 0; y < size; ++y) {
            if (at(x, y) != 2) continue;
            if (at(x, y - 1) != 2) sides[{x, y}].push_back({x + 1, y});
            if (at(x + 1, y) != 2) sides[{x + 1, y}].push_back({x + 1, y + 1});
            if (at(x, y + 1) != 2) sides[{x + 1, y + 1}].push_back({x, y + 1});
            if (at(x - 1, y) != 2) sides[{x, y + 1}].push_back({x, y});
        }
    Polygon polygon;
    std::map<std::pair<int, int>, int> known;
    while (!sides.empty()) {
        const std::pair<int, int> start = sides.begin()->first;
        std::pair<int, int> from = start;
        polygon.loops.emplace_back();
        do {
            auto& ways = sides[from];
            const std::size_t k = std::size_t(g.below(int(ways.size())));
            const std::pair<int, int> to = ways[k];
            ways.erase(ways.begin() + long(k));
            if (ways.empty()) sides.erase(from);
            const auto [found, fresh] = known.try_emplace(from, int(polygon.positions.size()));
            if (fresh || !shared_corners) {
                found->second = int(polygon.positions.size());
                polygon.positions.push_back({place(from), 0.0});
            }
            polygon.loops.back().push_back(found->second);
            from = to;
        } while (from != start);
    }
    return polygon;
}

}  // namespace

TEST_CASE("Polygons with holes get triangles that fill them, whatever the holes") {
    std::size_t holes = 0, max_corners = 0;
    for (const auto seed : seeds(2'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const bool grid = g.chance(0.4);
        const Polygon polygon =
            of_squares(g, 2 + g.below(15), g.between(0.6, 0.95), grid ? 0 : g.between(0, 0.25), g.chance(0.5));
        holes += polygon.loops.size() - 1;
        max_corners = std::max(max_corners, polygon.corners());
        check_clean(polygon, true);
    }
    CHECK(holes > 4'000);
    CHECK(max_corners > 200);
}

TEST_CASE("A plate with many holes, in rows or anywhere, turned or not, is triangulated") {
    for (const double turn : {0.0, 0.3})
        for (const int sides : {3, 4, 12, 16})
            for (const int n : {1, 5, 10}) {
                CAPTURE(turn, sides, n);
                Polygon plate;
                const auto turned = [&](std::vector<Vec2> points) {
                    for (Vec2& x : points)
                        x = {x.x * std::cos(turn) - x.y * std::sin(turn), x.x * std::sin(turn) + x.y * std::cos(turn)};
                    return points;
                };
                plate.add_loop(turned({{0, 0}, {double(n), 0}, {double(n), double(n)}, {0, double(n)}}));
                for (int i = 0; i < n; ++i)
                    for (int k = 0; k < n; ++k)
                        plate.add_loop(turned(ring({i + 0.5, k + 0.5}, 0.3, sides, true, pi / sides)));
                check_clean(plate);
            }
    for (int slots = 1; slots < 9; ++slots) {
        Polygon plate;
        plate.add_loop({{0, 0}, {80, 0}, {80, 30}, {0, 30}});
        for (int i = 0; i < slots; ++i) {
            const double x = 8 + 7 * i;
            plate.add_loop({{x, 8}, {x, 22}, {x + 2, 22}, {x + 2, 8}});
        }
        check_clean(plate);
    }
}

TEST_CASE("A polygon with a thousand holes of twelve sides takes a fraction of a second") {
    Polygon plate;
    plate.add_loop({{0, 0}, {40, 0}, {40, 25}, {0, 25}});
    for (int i = 0; i < 40; ++i)
        for (int k = 0; k < 25; ++k) plate.add_loop(ring({i + 0.5, k + 0.5}, 0.3, 12, true, pi / 12));
    const auto start = std::clock();
    check_clean(plate);
    CHECK(double(std::clock() - start) / CLOCKS_PER_SEC < 2);  // 0.03 s optimized
}

TEST_CASE("Sides keep the corners on them, and corners may touch sides and corners") {
    SECTION("corners along straight sides stay") {
        Polygon polygon;
        std::vector<Vec2> outer;
        for (int k = 0; k < 10; ++k) outer.push_back({0.1 * k, 0.03 * k});
        for (int k = 0; k < 10; ++k) outer.push_back({1 - 0.1 * k, 0.3 + 0.07 * k});
        polygon.add_loop(outer);
        check_clean(polygon);
    }
    SECTION("a hole that touches a side from within") {
        Polygon polygon;
        polygon.add_loop({{0, 0}, {4, 0}, {4, 4}, {0, 4}});
        polygon.add_loop({{2, 0}, {1, 2}, {3, 2}});
        check_clean(polygon, true);
    }
    SECTION("holes that touch each other at corners, the rim at a corner, and a side") {
        Polygon polygon;
        polygon.add_loop({{0, 0}, {4, 0}, {4, 4}, {0, 4}});
        polygon.add_loop({{0, 0}, {1, 2}, {2, 1}});
        polygon.add_loop({{2, 1}, {2, 3}, {3, 1}});
        polygon.add_loop({{3, 1}, {3, 2}, {4, 1}});
        check_clean(polygon, true);
    }
    SECTION("a corner three times, an edge without length, and a side there and back") {
        Polygon polygon;
        polygon.add_loop({{0, 0}, {4, 0}, {4, 0}, {4, 4}, {2, 2}, {2, 2}, {2, 2}, {0, 4}, {2, 1}, {0, 4}});
        const PolygonTriangles result = triangulate(polygon.loops, polygon.positions, {0, 0, 1});
        const Faults f = faults(polygon, result.triangles);
        CHECK(f.lost_sides == 0);
        CHECK(f.open_edges == 0);
        CHECK(f.inverted == 0);
        CHECK(f.area == Approx(polygon.area()));
    }
    SECTION("a slit into the polygon, another that is a hole, and corners on sides from outside") {
        Polygon polygon;
        polygon.positions = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0},   {0, 4, 0}, {0, 1, 0}, {2, 1, 0}, {1, 1, 0},
                             {1, 2, 0}, {3, 3, 0}, {2, 2.5, 0}, {2, 0, 0}, {4, 2, 0}, {5, 1, 0}, {5, 3, 0}};
        int touches = 0;
        SECTION("slits") { polygon.loops = {{0, 1, 2, 3, 4, 5, 6, 4}, {7, 8, 9}}; }
        SECTION("from outside, and in a second part from within") {
            polygon.loops = {{0, 1, 2, 3}, {1, 12, 11, 13, 2}};
            touches = 1;
        }
        const PolygonTriangles result = triangulate(polygon.loops, polygon.positions, {0, 0, 1});
        const Faults f = faults(polygon, result.triangles);
        CHECK(f.lost_sides == 0);
        CHECK(f.open_edges == 0);
        CHECK(f.inverted == 0);
        CHECK(f.flat == touches);
        CHECK(f.area == Approx(polygon.area()));
    }
    SECTION("all corners on a line") {
        Polygon polygon;
        polygon.add_loop({{0, 0}, {1, 1}, {3, 3}, {2, 2}});
        const Faults f = faults(polygon, triangulate(polygon.loops, polygon.positions, {0, 0, 1}).triangles);
        CHECK(f.lost_sides == 0);
        CHECK(f.open_edges == 0);
    }
}

TEST_CASE("A rim that crosses itself keeps its edges, and this is said") {
    int crossing = 0, lost = 0;
    for (const auto seed : seeds(2'000)) {
        CAPTURE(seed);
        Gen g(seed);
        Polygon polygon;
        std::vector<Vec2> points = ring({0, 0}, 1, 5 + g.below(12), false);
        const double moved = g.chance(0.5) ? 0.3 : 1e-9;
        for (Vec2& x : points) x += moved * Vec2(g.between(-1, 1), g.between(-1, 1));
        // One corner reaches through a side of another part of the rim, by little or by much.
        if (g.chance(0.5)) points[2] = 0.5 * (points[0] + points[points.size() - 1]) * (1 + moved);
        polygon.add_loop(points);
        if (g.chance(0.5)) polygon.add_loop(ring({g.between(-0.6, 0.6), 0.1}, g.between(0.1, 0.6), 5, true));
        const PolygonTriangles result = triangulate(polygon.loops, polygon.positions, {0, 0, 1});
        const Faults f = faults(polygon, result.triangles);
        CHECK(f.unbalanced == 0);
        lost += f.lost_sides > 0;
        CHECK((f.inverted == 0 || result.crosses_itself));
        CHECK(f.area == Approx(polygon.area()).epsilon(1e-9));
        crossing += result.crosses_itself;
    }
    CHECK(crossing > 500);
    CHECK(lost < crossing / 10);  // sides of triangles that are inverted or lie twice on the polygon
}

TEST_CASE("Ears of loops are a disc, whatever crosses") {
    for (const auto seed : seeds(200)) {
        CAPTURE(seed);
        Gen g(seed);
        Polygon polygon;
        std::vector<std::vector<Vec2>> places;
        for (int loops = 1 + g.below(4); loops > 0; --loops) {
            places.emplace_back();
            for (int n = 3 + g.below(9); n > 0; --n) places.back().push_back({g.number(), g.number()});
            polygon.add_loop(places.back());
        }
        const auto triangles = loop_ears(polygon.loops, places);
        CHECK(triangles.size() == polygon.corners() - 2 + 2 * (polygon.loops.size() - 1));
        const Faults f = faults(polygon, triangles);
        CHECK(f.unbalanced == 0);
    }
}

TEST_CASE("Orientations are exact next to a line and a plane") {
    constexpr double ulp = 0x1p-52;
    int differs = 0;
    for (int i = -8; i <= 8; ++i)
        for (int k = -8; k <= 8; ++k) {
            // Points around (½, ½) on a grid of half an ulp: their exact side of the diagonal is the sign of k − i.
            const Vec2 x(0.5 + i * ulp / 2, 0.5 + k * ulp / 2);
            const double side = orientation({12, 12}, {24, 24}, x);
            CHECK((side > 0) == (k > i));
            CHECK((side < 0) == (k < i));
            const Vec2 u = Vec2(12, 12) - x, v = Vec2(24, 24) - x;
            differs += (u.x * v.y - u.y * v.x > 0) != (k > i);
            const double above = orientation({0, 0, 0}, {12, 12, 12}, {24, 24, -3}, {x.x, x.y, 0.3});
            CHECK((above > 0) == (k > i));
            CHECK((above < 0) == (k < i));
        }
    CHECK(differs > 20);  // plain floating-point arithmetic is wrong that often
}
