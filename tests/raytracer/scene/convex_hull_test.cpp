// Convex hulls: faces, flatness, and points without a volume.
#include "raytracer/scene/convex_hull.hpp"

#include <algorithm>
#include <random>

#include "catch.hpp"
#include "raytracer/scene/polygon.hpp"

using namespace deburr;

namespace {

Mat3 rotation(std::mt19937& gen) {
    std::normal_distribution<double> normal;
    const auto unit = [&] { return glm::normalize(Vec3(normal(gen), normal(gen), normal(gen))); };
    const Vec3 x = unit(), y = glm::normalize(glm::cross(x, unit()));
    return Mat3(x, y, glm::cross(x, y));
}

void check_holds(const std::vector<HullFace>& hull, const std::vector<Vec3>& points, double size) {
    double outside = 0;
    for (const HullFace& face : hull) {
        double touching = infinity;
        for (Vec3 p : points) {
            outside = std::max(outside, glm::dot(face.normal, p) - face.offset);
            touching = std::min(touching, std::abs(glm::dot(face.normal, p) - face.offset));
        }
        CHECK(touching <= 1e-14 * size);
    }
    CHECK(outside <= 1e-9 * size);  // faces are merged if they are flat to this
}

}  // namespace

TEST_CASE("a turned grid of points has six faces, and no point is outside") {
    for (unsigned seed = 0; seed < 20; ++seed) {
        CAPTURE(seed);
        std::mt19937 gen(seed);
        const Mat3 turn = rotation(gen);
        const double scale = std::pow(10.0, int(seed) - 10);
        std::vector<Vec3> points;
        for (int i = 0; i < 6; ++i)
            for (int j = 0; j < 6; ++j)
                for (int k = 0; k < 6; ++k) points.push_back(scale * (turn * Vec3(i, 2 * j, 3 * k)));
        const auto hull = convex_hull(points);
        CHECK(hull.size() == 6);
        check_holds(hull, points, 20 * scale);
        std::shuffle(points.begin(), points.end(), gen);
        const auto again = convex_hull(points);
        REQUIRE(again.size() == hull.size());
        for (std::size_t i = 0; i < hull.size(); ++i) {
            CHECK(again[i].normal == hull[i].normal);
            CHECK(again[i].offset == hull[i].offset);
        }
    }
}

TEST_CASE("a turned cylinder of n sides has n + 2 faces") {
    for (const int n : {3, 4, 5, 8, 12, 64, 360}) {
        CAPTURE(n);
        std::mt19937 gen{unsigned(n)};
        const Mat3 turn = rotation(gen);
        std::vector<Vec3> points;
        std::vector<glm::dvec2> polygon;
        for (int i = 0; i < n; ++i) {
            const double a = 2 * glm::radians(180.0) * i / n;
            polygon.emplace_back(std::cos(a), std::sin(a));
            for (const double y : {-1.0, 2.0}) points.push_back(turn * Vec3(polygon.back().x, y, polygon.back().y));
        }
        const auto hull = convex_hull(points);
        CHECK(hull.size() == std::size_t(n) + 2);
        check_holds(hull, points, 4);
        CHECK(prism(polygon, -1, 2).node().children().size() == std::size_t(n) + 2);
    }
}

TEST_CASE("thin and random bodies hold their points") {
    for (unsigned seed = 0; seed < 40; ++seed) {
        CAPTURE(seed);
        std::mt19937 gen(seed);
        std::uniform_real_distribution<double> uniform(-1, 1);
        const Mat3 turn = rotation(gen);
        const double thickness = std::pow(10.0, -double(seed % 8));
        std::vector<Vec3> points;
        for (int i = 0; i < 4 + int(seed); ++i)
            points.push_back(turn * Vec3(uniform(gen), thickness * uniform(gen), uniform(gen)));
        const auto hull = convex_hull(points);
        CHECK(hull.size() >= 4);
        check_holds(hull, points, 2);
    }
}

TEST_CASE("points without a volume are refused at every scale and place") {
    for (unsigned seed = 0; seed < 20; ++seed) {
        CAPTURE(seed);
        std::mt19937 gen(seed);
        std::uniform_real_distribution<double> uniform(-1, 1);
        const Mat3 turn = rotation(gen);
        const double scale = std::pow(10.0, int(seed) - 10);
        std::vector<Vec3> flat, line;
        for (int i = 0; i < 10; ++i) {
            flat.push_back(scale * (turn * Vec3(uniform(gen), 0, uniform(gen)) + Vec3(5, 6, 7)));
            line.push_back(scale * (turn * Vec3(uniform(gen), 0, 0) + Vec3(5, 6, 7)));
        }
        CHECK_THROWS_AS(convex_hull(flat), std::runtime_error);
        CHECK_THROWS_AS(convex_hull(line), std::runtime_error);
    }
}
