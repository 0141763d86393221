// Prisms over polygons: membership, half-planes, rounding and holes.
#include "raytracer/scene/polygon.hpp"

#include <random>

#include "bounds/bounding_box.hpp"
#include "catch.hpp"

using namespace deburr;

namespace {

using Points = std::vector<Vec2>;

// True if p is inside by definition: a ray from p crosses the boundary an odd number of times.
bool inside(const Points& polygon, Vec2 p) {
    bool in = false;
    for (std::size_t i = 0, k = polygon.size() - 1; i < polygon.size(); k = i++) {
        const Vec2 a = polygon[i], b = polygon[k];
        if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y)) in = !in;
    }
    return in;
}

// A comb whose teeth have one height, so that all tips are on one line, and so are all roots.
Points comb(int teeth) {
    Points points{{0, 0}, {2.0 * teeth, 0}};
    for (int i = teeth; i-- > 0;)
        for (const Vec2 p : {Vec2(2 * i + 1.5, 1), Vec2(2 * i + 1.2, 3), Vec2(2 * i + 0.4, 3), Vec2(2 * i + 0.2, 1)})
            points.push_back(p);
    return points;
}

Points spiral(int turns) {
    Points outer, inner;
    for (int i = 0; i <= 12 * turns; ++i) {
        const double angle = i * pi / 6, radius = 1 + 0.1 * i;
        outer.push_back(radius * Vec2(std::cos(angle), std::sin(angle)));
        inner.push_back((radius - 0.6) * Vec2(std::cos(angle), std::sin(angle)));
    }
    outer.insert(outer.end(), inner.rbegin(), inner.rend());
    return outer;
}

// A star-shaped polygon around the origin, with spikes and notches.
Points star(unsigned seed) {
    std::mt19937 gen(seed);
    std::uniform_real_distribution<double> radius(0.3, 3), angle(0, 1);
    Points points;
    const int n = 3 + int(seed % 30);
    for (int i = 0; i < n; ++i) {
        const double a = 2 * pi * (i + 0.8 * angle(gen)) / n;
        points.push_back(radius(gen) * Vec2(std::cos(a), std::sin(a)));
    }
    return points;
}

const Points letter_e{{0, 0},   {3, 0}, {3, 1}, {1, 1}, {1, 2}, {2.5, 2},
                      {2.5, 3}, {1, 3}, {1, 4}, {3, 4}, {3, 5}, {0, 5}};

std::vector<Points> polygons() {
    std::vector<Points> all{comb(1), comb(5), spiral(1), spiral(4), letter_e, {{0, 0}, {3, 0}, {1, 1}, {0, 3}}};
    for (unsigned seed = 0; seed < 60; ++seed) all.push_back(star(seed));
    return all;
}

bool turns_left_only(const Points& polygon) {
    const std::size_t n = polygon.size();
    double most = -infinity, least = infinity;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec2 a = polygon[(i + 1) % n] - polygon[i], b = polygon[(i + 2) % n] - polygon[(i + 1) % n];
        most = std::max(most, a.x * b.y - a.y * b.x);
        least = std::min(least, a.x * b.y - a.y * b.x);
    }
    return most * least > 0;
}

Vec3 at(Vec2 p, double height, PrismAxis axis) {
    switch (axis) {
        case PrismAxis::x: return {height, p.x, p.y};
        case PrismAxis::y: return {p.x, height, p.y};
        default: return {p.x, p.y, height};
    }
}

}  // namespace

TEST_CASE("a prism is its polygon, whatever its shape, winding, start and axis") {
    std::mt19937 gen(7);
    std::uniform_real_distribution<double> uniform(-6, 12);
    int in = 0;
    for (Points polygon : polygons())
        for (const bool turned : {false, true}) {
            std::rotate(polygon.begin(), polygon.begin() + std::ptrdiff_t(polygon.size() / 3), polygon.end());
            if (turned) std::reverse(polygon.begin(), polygon.end());
            const auto axis = PrismAxis(gen() % 3);
            const DensityTree tree = flatten(prism(polygon, 1, 2, axis), 0.0);
            for (int i = 0; i < 300; ++i) {
                const Vec2 p = i % 2 ? Vec2(uniform(gen), uniform(gen)) : 0.3 * Vec2(uniform(gen), uniform(gen));
                CAPTURE(p.x, p.y, polygon.size());
                const bool expected = inside(polygon, p);
                in += expected;
                REQUIRE((tree.at(at(p, 1.5, axis)) > 0.5) == expected);
                REQUIRE_FALSE(tree.at(at(p, 0.5, axis)) > 0.5);
                REQUIRE_FALSE(tree.at(at(p, 2.5, axis)) > 0.5);
            }
        }
    CHECK(in > 5'000);
}

TEST_CASE("a star, none of whose sides bounds it, is in its box, which rounding does not touch") {
    Points points;
    for (int i = 0; i < 10; ++i) {
        const double a = i * pi / 5;
        points.push_back((i % 2 ? 1.0 : 3.0) * Vec2(std::cos(a), std::sin(a)));
    }
    const double tip = 3 * std::sin(2 * pi / 5);
    for (const double r : {0.0, 0.1, 0.8}) {
        const DensityTree tree = flatten(prism(points, 0, 1), r);
        const Box box = bounding_box(tree);
        CHECK(box.hi.x == Approx(3 + r).margin(1e-6));
        CHECK(box.hi.z == Approx(tip + r).margin(1e-6));
        const Density without = raised_polygon(points, PrismAxis::y) & Density::box({-9, 0, -9}, {9, 1, 9});
        const DensityTree bare = flatten(without, r);
        std::mt19937 gen(1);
        std::uniform_real_distribution<double> uniform(-3, 3);
        for (int i = 0; i < 500; ++i) {
            const Vec3 x(uniform(gen), 0.5, uniform(gen) * tip / 3);
            if (x.x < -3 * std::cos(pi / 5)) continue;
            CHECK(tree.at(x) == Approx(bare.at(x)).margin(1e-14));
        }
    }
}

TEST_CASE("a prism names the half-plane of each side once and no other") {
    for (const Points& polygon : polygons())
        CHECK(prism(polygon, 0, 1).node().leaves == double(polygon.size()) + (turns_left_only(polygon) ? 2 : 6));
    Points more = letter_e;
    more.insert(more.begin() + 1, {1.5, 0});
    more.push_back(more.front());
    CHECK(prism(more, 0, 1).node().leaves == double(letter_e.size()) + 6);
}

TEST_CASE("a prism with corners to the inside is the union of boxes, density for density") {
    const Density by_boxes = Density::box({0, 0, 0}, {1, 1, 5}) | Density::box({0, 0, 0}, {3, 1, 1}) |
                             Density::box({0, 0, 2}, {2.5, 1, 3}) | Density::box({0, 0, 4}, {3, 1, 5});
    for (const double r : {0.2, 0.9}) {
        const DensityTree one = flatten(prism(letter_e, 0, 1), r), many = flatten(by_boxes, r);
        std::mt19937 gen(3);
        std::uniform_real_distribution<double> uniform(-1, 6);
        for (int i = 0; i < 3'000; ++i) {
            const Vec3 x(uniform(gen), 0.3 * uniform(gen), uniform(gen));
            REQUIRE(one.at(x) == Approx(many.at(x)).margin(1e-13));
        }
    }
}

TEST_CASE("a rounded prism is flat along its sides and solid within, but near its corners") {
    int on_sides = 0, within = 0;
    for (const double r : {0.02, 0.1})
        for (const Points& polygon : polygons()) {
            const DensityTree tree = flatten(prism(polygon, -1, 1), r);
            const std::size_t n = polygon.size();
            const auto clearance = [&](Vec2 p, std::size_t but) {
                double nearest = infinity;
                for (std::size_t k = 0; k < n; ++k)
                    if (k != but) nearest = std::min(nearest, distance_to_segment(p, polygon[k], polygon[(k + 1) % n]));
                return nearest;
            };
            // The line of each side has a draw of its own. Where two lines cross near the point, each pair of outcomes
            // is that of a point nearby. With three lines, or two that cross far away, as at an obtuse corner, this
            // need not be so.
            const auto drawn_as_seen = [&](Vec2 p) {
                std::vector<std::pair<Vec2, Vec2>> lines;
                for (std::size_t k = 0; k < n; ++k) {
                    const Vec2 d = glm::normalize(polygon[(k + 1) % n] - polygon[k]), to = p - polygon[k];
                    if (std::abs(d.x * to.y - d.y * to.x) < r) lines.push_back({polygon[k], d});
                }
                if (lines.size() < 2) return true;
                const auto& [a, d] = lines[0];
                const auto& [b, e] = lines[1];
                const double sine = d.x * e.y - d.y * e.x;
                const Vec2 crossing = a + d * (((b.x - a.x) * e.y - (b.y - a.y) * e.x) / sine);
                return lines.size() == 2 && sine != 0 && glm::distance(crossing, p) < 2 * r;
            };
            for (std::size_t i = 0; i < n; ++i)
                for (int step = 1; step < 40; ++step) {
                    const Vec2 p = glm::mix(polygon[i], polygon[(i + 1) % n], step / 40.0);
                    if (clearance(p, i) < 2 * r || !drawn_as_seen(p)) continue;
                    ++on_sides;
                    CAPTURE(p.x, p.y, n);
                    CHECK(tree.at({p.x, 0, p.y}) == Approx(0.5).margin(1e-9));
                }
            std::mt19937 gen{unsigned(n)};
            std::uniform_real_distribution<double> uniform(-3, 3);
            for (int i = 0; i < 2'000; ++i) {
                const Vec2 p(uniform(gen), uniform(gen));
                if (!inside(polygon, p) || clearance(p, n) < 2 * r || !drawn_as_seen(p)) continue;
                ++within;
                CAPTURE(p.x, p.y, n);
                CHECK(tree.at({p.x, 0, p.y}) == 1);
            }
        }
    CHECK(on_sides > 5'000);
    CHECK(within > 5'000);
}

TEST_CASE("a prism's holes are rounded with it, and may touch its sides") {
    const Points square{{0, 0}, {4, 0}, {4, 4}, {0, 4}}, hole{{0, 1}, {2, 1}, {2, 2}, {0, 2}};
    const DensityTree tree = flatten(prism(square, 0, 1) & ~raised_polygon(hole, PrismAxis::y), 0.1);
    CHECK(tree.at({1, 0.5, 1.5}) == 0);
    CHECK(tree.at({-0.001, 0.5, 1.5}) == 0);  // no skin is left
    CHECK(tree.at({3, 0.5, 3}) == 1);
    CHECK(tree.at({1, 0.5, 1}) == Approx(0.5).margin(1e-13));
}
