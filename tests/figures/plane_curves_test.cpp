// Level lines of plane functions, shares of discs in polygons, height fields and animated PNGs.
#include "figures/plane_curves.hpp"

#include <random>

#include "catch.hpp"
#include "figures/animation.hpp"
#include "figures/height_field.hpp"

using namespace deburr;

TEST_CASE("A level line of a circle's equation closes and lies on the circle") {
    const auto lines = level_lines([](Vec2 x) { return 2 - glm::dot(x, x); }, 1, {-2, -2}, {2, 2}, 37, 41);
    REQUIRE(lines.size() == 1);
    CHECK(lines[0].front() == lines[0].back());
    for (const Vec2& p : lines[0]) CHECK(glm::length(p) == Approx(1).epsilon(1e-12));
}

TEST_CASE("Level lines that end at the border stay open, and a saddle's do not cross") {
    const auto open = level_lines([](Vec2 x) { return x.x + 0.3 * x.y; }, 0.1, {-1, -1}, {1, 1}, 10, 10);
    REQUIRE(open.size() == 1);
    CHECK(open[0].front() != open[0].back());
    CHECK(std::max(std::abs(open[0].front().y), std::abs(open[0].back().y)) == Approx(1));
    CHECK(level_lines([](Vec2 x) { return x.x * x.y; }, 0.01, {-1, -1}, {1, 1}, 9, 9).size() == 2);
}

TEST_CASE("The share of a disc in a polygon is that of random points") {
    const std::vector<Vec2> polygon = {{0, 0}, {4, 0}, {4, 1}, {2, 1}, {2, 3}, {0, 2}};
    const auto inside = [&](Vec2 x) {
        bool in = false;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const Vec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
            if ((a.y > x.y) != (b.y > x.y) && x.x < a.x + (x.y - a.y) / (b.y - a.y) * (b.x - a.x)) in = !in;
        }
        return in;
    };
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (const Vec2 center : {Vec2(0, 0), Vec2(2, 1), Vec2(1, 2.4), Vec2(3, 0.5), Vec2(4.5, 0.5), Vec2(9, 9)})
        for (const double radius : {0.3, 1.0, 5.0}) {
            int hits = 0, points = 0;
            while (points < 20000) {
                const Vec2 x(unit(random), unit(random));
                if (glm::dot(x, x) > 1) continue;
                ++points;
                hits += inside(center + radius * x);
            }
            CHECK(disc_share(polygon, center, radius) == Approx(hits / double(points)).margin(0.02));
        }
    // These shares are exact: half on a side, a quarter in a square corner, and all inside.
    CHECK(disc_share(polygon, {1, 0}, 0.5) == Approx(0.5).epsilon(1e-13));
    CHECK(disc_share(polygon, {0, 0}, 0.5) == Approx(0.25).epsilon(1e-13));
    CHECK(disc_share(polygon, {1, 1}, 0.5) == Approx(1).epsilon(1e-13));
}

TEST_CASE("A height field goes through its function's values and stands on the ground") {
    const Mesh mesh = height_field([](Vec2 x) { return 0.25 * (x.x + x.y); }, {0, 0}, {2, 1}, 8, 4, 3);
    for (std::size_t i = 0; i < 9 * 5; ++i) {
        const Vec3 x = mesh.positions[i];
        CHECK(x.y == Approx(3 * 0.25 * (x.x - x.z)).margin(1e-12));
    }
    // The volume under the field; the ground's part of the divergence sum is 0.
    CHECK(volume(mesh) == Approx(3 * 0.25 * (1.0 + 0.5) * 2).epsilon(1e-9));
}

TEST_CASE("An animated PNG holds its frames in order") {
    std::vector<Film> frames;
    for (const double grey : {0.0, 0.5, 1.0}) {
        Film film(6, 4, {0, 0, 6, 4});
        for (Pixel& p : film.pixels) p.color = Vec3(grey);
        frames.push_back(film);
    }
    const std::string png = animated_png(frames, 0.1);
    CHECK(png.substr(1, 3) == "PNG");
    std::string types;
    std::size_t at = 8;
    while (at < png.size()) {
        const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(png[at + k]); };
        const std::size_t size =
            std::size_t(byte(0)) << 24 | std::size_t(byte(1)) << 16 | std::size_t(byte(2)) << 8 | byte(3);
        types += png.substr(at + 4, 4) + " ";
        at += size + 12;
    }
    CHECK(at == png.size());
    CHECK(types.find("acTL") < types.find("fcTL"));
    CHECK(types.find("fcTL IDAT fcTL fdAT fcTL fdAT IEND ") != std::string::npos);
    CHECK(types.find("IHDR ") == 0);
}
