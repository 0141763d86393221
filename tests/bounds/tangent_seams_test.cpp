// Tangent seams: where round parts run on smoothly into other surfaces.
#include "bounds/tangent_seams.hpp"

#include "catch.hpp"
#include "random_case.hpp"

using namespace deburr;

namespace {

std::vector<TangentSeam> seams(const Density& d, double r = 0.1) { return tangent_seams(flatten(d, r)); }

Density rod(Vec3 from, Vec3 to, double R) { return Density::cylinder(from, to, R); }

}  // namespace

TEST_CASE("surfaces that run on smoothly are found, with how much they bulge") {
    const double r = 0.1;
    const Density half_disc = rod({2, 0, -1}, {2, 0, 1}, 0.5), box = Density::box({0, -0.5, -1}, {2, 0.5, 1});
    struct Case {
        const char* name;
        Density density;
    };
    const Case all[] = {
        {"a box that runs into a half-cylinder", box | half_disc},
        {"a rod with a ball at its end", rod({0, 0, 0}, {0, 2, 0}, 0.5) | Density::sphere({0, 2, 0}, 0.5)},
        {"a ball in the tip of a cone",
         Density::cone({0, 0, 0}, {0, 2, 0}, 1, 0) | Density::sphere({0, 0.6, 0}, 1.4 / std::sqrt(5.0))},
        {"a plane along a ring", Density::torus(Vec3(0.0), {0, 1, 0}, 1, 0.4) | rod({0, -0.4, 0}, {0, 0.4, 0}, 1)},
        {"a ball in a larger one", Density::sphere(Vec3(0.0), 1) | Density::sphere({0.4, 0, 0}, 0.6)},
        {"a rod along the inside of another", rod({0, -1, 0}, {0, 1, 0}, 1) | rod({0.4, -1, 0}, {0.4, 1, 0}, 0.6)},
    };
    for (const Case& c : all) {
        CAPTURE(c.name);
        const DensityTree tree = flatten(c.density, r);
        const std::vector<TangentSeam> found = tangent_seams(tree);
        REQUIRE(!found.empty());
        for (const TangentSeam& seam : found) {
            CHECK(seam.radius == r);
            CHECK(seam.bulge > 0.02 * r);
            CHECK(seam.bulge < 0.36 * r);
        }
    }
    // Near the point of contact this is a union of two equal half-spaces: ρ = 1 − (1 − F)² = ½ where F = 1 − √½.
    const double expected = displacement(1 - std::sqrt(0.5));
    const auto two = seams(Density::sphere(Vec3(0.0), 1) | Density::sphere({0.4, 0, 0}, 0.6));
    REQUIRE(two.size() == 1);
    CHECK(largest(two[0].at - Vec3(1, 0, 0)) < 1e-9);
    CHECK(two[0].bulge == Approx(r * expected).epsilon(0.02));
}

TEST_CASE("a seam's bulge is told where its ends' rounded edges are none of it") {
    const Density slot = Density::box({0, 0, 0}, {2, 1, 1}) | rod({2, 0, 0.5}, {2, 1, 0.5}, 0.5);
    for (const double r : {0.02, 0.05, 0.1}) {
        CAPTURE(r);
        const auto found = seams(slot, r);
        REQUIRE(found.size() == 2);
        for (const TangentSeam& seam : found) {
            CHECK(seam.bulge < 0.36 * r);
            CHECK(seam.at.y > r);
            CHECK(seam.at.y < 1 - r);
        }
    }
}

TEST_CASE("where surfaces meet in edges, share a draw or touch from outside there is no seam") {
    const Density cube = Density::box(Vec3(-1.0), Vec3(1.0));
    CHECK(seams(cube | rod({0, 0, 0}, {0, 3, 0}, 0.5)).empty());
    CHECK(seams(cube & ~rod({0, -3, 0}, {0, 3, 0}, 0.5)).empty());
    CHECK(seams(cube | Density::sphere({0, 1, 0}, 0.5)).empty());
    CHECK(seams(rod({0, 0, 0}, {0, 2, 0}, 1) | rod({0, 1, 0}, {0, 3, 0}, 1)).empty());  // flush: one family
    CHECK(seams(Density::sphere({0, 2, 0}, 1) | cube).empty());                         // touches from outside
    CHECK(seams(Density::torus(Vec3(0.0), {0, 1, 0}, 1, 0.3)).empty());
    // Where the two would touch, one of them is cut away.
    CHECK(seams((cube | rod({0, 0.5, -0.5}, {0, 0.5, 0.5}, 0.5)) & Density::half_space({0, 1, 0}, 0.5)).empty());
    CHECK(seams(cube).empty());
}

namespace {

// A part whose surface passes through x with outward normal n. `shape`: 0 plane, 1 ball, 2 rod, 3 torus, 4 cone; rods
// and cones contain the line through x along `along`.
Density touching(Gen& g, int shape, Vec3 x, Vec3 n, Vec3 along) {
    const Vec3 other = glm::cross(n, along);
    const double R = g.between(0.3, 0.6);
    const Vec3 inside = x - R * n;
    if (shape == 0) return Density::half_space(n, glm::dot(n, x));
    if (shape == 1) return Density::sphere(inside, R);
    if (shape == 2) return rod(inside - 4.0 * along, inside + 4.0 * along, R);
    if (shape == 4) {  // a cone with its apex on that line
        const double angle = g.between(0.1, 1.4), length = g.between(0.4, 1.5);
        const Vec3 apex = x + length * along, axis = -std::cos(angle) * along - std::sin(angle) * n;
        return Density::cone(apex, apex + 4.0 * axis, 0, 4 * std::tan(angle));
    }
    const double ring = R + g.between(0.3, 1), angle = g.between(0, 6.28);
    const Vec3 away = std::cos(angle) * n + std::sin(angle) * other;
    return Density::torus(inside - ring * away, glm::cross(away, along), ring, R);
}

}  // namespace

TEST_CASE("parts that touch however they lie are found, and nothing a hundredth of a radius off") {
    const double r = 0.1;
    constexpr const char* names[] = {"plane", "ball", "rod", "ring", "cone"};
    int tried[5][5][2] = {}, wrong = 0;
    for (auto seed : seeds(2'000)) {
        Gen g(seed);
        const int a = 1 + g.below(4), b = g.below(a + 1);
        const bool opposite = g.chance(0.3);  // the parts touch from outside, as a fillet and a wall do
        CAPTURE(seed, names[a], names[b], opposite);
        const Vec3 x = g.point(1), n = glm::normalize(g.point(1));
        const Vec3 along = glm::normalize(glm::cross(n, g.point(1))),
                   across = glm::normalize(glm::cross(n, g.point(1)));
        const Density first = touching(g, a, x, n, along), second = touching(g, b, x, opposite ? -n : n, across);
        const bool in_line = b == 0 && (a == 2 || a == 4);
        const auto at_x = [&](const Density& of) {
            const Density all = opposite ? (first | ~of) & Density::box(x - 8.0, x + 8.0)
                                : b == 0 ? first & of
                                         : first | of;
            for (const TangentSeam& seam : seams(all, r))
                if (glm::length(seam.at - x - (in_line ? along * glm::dot(along, seam.at - x) : Vec3(0.0))) < 1e-4)
                    return true;
            return false;
        };
        CHECK(at_x(second));
        ++tried[a][b][opposite];
        wrong += at_x(second.transformed({Mat3(1.0), 0.01 * r * (g.chance(0.5) ? n : -n)}));
    }
    for (int a = 1; a < 5; ++a)
        for (int b = 0; b <= a; ++b)
            for (const int opposite : {0, 1}) CHECK(tried[a][b][opposite] > 15);
    CHECK(wrong == 0);
}

TEST_CASE("cones that touch along a line are found, and cones and rods about one ball") {
    const auto cone = [](Vec3 apex, Vec3 axis, double tangent) {
        return Density::cone(apex, apex + 4.0 * axis, 0, 4 * tangent);
    };
    const Density wide = cone({0, 0, 0}, {0, 0, 1}, 1);
    // `generator` is the cone's line through (1, 0, 1), and n its normal there.
    const double R = 0.3;
    const Vec3 n = Vec3(1, 0, -1) / std::sqrt(2.0), generator = Vec3(1, 0, 1) / std::sqrt(2.0);
    CHECK(seams(wide | rod(0.5 * generator - R * n, 3.0 * generator - R * n, R)).size() == 1);
    CHECK(seams(wide | cone(0.5 * generator, {0, 0, 1}, 1)).size() == 1);
    const double narrow = 0.3, lean = 0.25 * 3.14159265358979323846 - narrow;
    CHECK(seams(wide | cone(0.5 * generator, {std::sin(lean), 0, std::cos(lean)}, std::tan(narrow))).size() == 1);
    CHECK(seams(wide | cone({0, 0, 0}, {std::sin(lean), 0, std::cos(lean)}, std::tan(narrow))).size() == 1);
    CHECK(seams(wide | cone({0, 0, 0}, {0, 0, 1}, 0.5)).empty());
    CHECK(seams(wide | cone(0.49 * generator + 0.01 * n, {0, 0, 1}, 1)).empty());
    // The ball of radius √2 around (0, 0, 2) touches the cone. So does a rod of that radius through the ball's center.
    for (const Vec3 across : {Vec3(1, 0, 0), glm::normalize(Vec3(1, 2, 0.5)), glm::normalize(Vec3(1, 0, -0.9))}) {
        const Vec3 middle(0, 0, 2);
        CHECK(seams(wide | rod(middle, middle + 6.0 * across, std::sqrt(2.0))).size() == 1);
        CHECK(seams(wide | rod(middle, middle + 6.0 * across, std::sqrt(2.0) - 1e-3)).empty());
    }
    // A torus whose tube contains that ball touches the cone, too.
    const Density ring = Density::torus({3, 0, 2}, {0, 0, 1}, 3, std::sqrt(2.0));
    CHECK(seams(wide | ring).size() == 1);
}

TEST_CASE("a fillet in the corner of two walls, or about a pin's foot, runs on into them") {
    const double r = 0.05, R = 0.5;
    const Density floor = Density::box({-3, -3, -1}, {3, 3, 0}), wall = Density::box({-1, -3, -1}, {0, 3, 3});
    const Density corner = Density::box({-0.5, -2, -0.5}, {R, 2, R}) & ~rod({R, -4, R}, {R, 4, R}, R);
    const auto in_corner = seams(floor | wall | corner, r);
    CHECK(in_corner.size() == 2);
    for (const TangentSeam& seam : in_corner) CHECK(std::min(std::abs(seam.at.x), std::abs(seam.at.z)) < 1e-9);
    const Density pin = rod({0, 0, 0}, {0, 0, 3}, 0.6), ring = Density::torus({0, 0, R}, {0, 0, 1}, 0.6 + R, R - 1e-12);
    CHECK(seams(floor | pin | (rod({0, 0, -0.5}, {0, 0, R}, 0.6 + R) & ~ring), r).size() == 2);
    // A groove that does not reach the face makes no seam.
    CHECK(seams(floor & ~rod({0, -4, R}, {0, 4, R}, R - 0.01), r).empty());
}

TEST_CASE("rods of one radius that cross touch above and below, rings that run on do so all around") {
    const auto cross = seams(rod({-2, 0, 0}, {2, 0, 0}, 0.5) | rod({0, 0, -2}, {0, 0, 2}, 0.5));
    REQUIRE(cross.size() == 1);
    CHECK(largest(glm::abs(cross[0].at) - Vec3(0, 0.5, 0)) < 1e-6);
    const Density ring = Density::torus(Vec3(0.0), {0, 1, 0}, 1, 0.3);
    const auto leaned =
        Density::torus({2, 0, 0}, glm::normalize(Vec3(0, 1, 1)), 1, 0.3);  // both circles share one point
    CHECK(seams(ring | leaned).size() == 1);
    CHECK(seams(ring | Density::sphere(Vec3(0.0), 1.3)).size() == 1);      // touches all around the ball
    CHECK(seams(ring & rod({0.5, -1, 0}, {0.5, 1, 0}, 1.8)).size() == 1);  // at (−1.3, 0, 0)
    CHECK(seams(ring & rod({0.5, -1, 0}, {0.5, 1, 0}, 1.7)).empty());
    // Half-tori that meet in the plane between them, as in a spring, do not bulge.
    const Density plane = Density::half_space({1, 0, 0}, 0);
    const auto half = [&](double y, double lean) {
        return Density::torus({0, y, 0}, glm::normalize(Vec3(0, 1, lean)), 1, 0.3);
    };
    const double lean = 0.2, rise = 2 * lean / std::sqrt(1 + lean * lean);
    CHECK(seams((half(0, lean) & plane) | (half(rise, -lean) & ~plane), 0.02).empty());
}
