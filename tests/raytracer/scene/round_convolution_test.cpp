// True convolution of densities with round parts, which uses a mesh of the solid.
#include "raytracer/scene/round_convolution.hpp"

#include <algorithm>

#include "bounds/ball_convolution.hpp"
#include "bounds/mesh_field.hpp"
#include "catch.hpp"
#include "random_case.hpp"

using namespace deburr;

namespace {

// Signed distance from x along the unit normal at which the share falls through ½; it must do so within r.
template <class Share>
double level(const Share& share, Vec3 x, Vec3 normal, double r) {
    double inside = -r, outside = r;
    for (int i = 0; i < 40; ++i) {
        const double middle = 0.5 * (inside + outside);
        (share(x + middle * normal) > 0.5 ? inside : outside) = middle;
    }
    return 0.5 * (inside + outside);
}

struct Convolved {
    Convolved(double r, const Density& density) : solid(convolved_round(r, density, 0)) {
        const FieldPtr& of = solid.node().field();
        REQUIRE(of);
        field = of.get();
    }
    double level(Vec3 x, Vec3 normal, double within) const {
        return ::level([&](Vec3 y) { return 0.5 + field->at(y).value; }, x, normal, within);
    }
    Solid solid;
    const Field* field;
};

// Share of a ball that is inside a ball 1/k times as large, whose surface is a radii away [docs/design.md, Round
// primitives].
double share_of_sphere(double a, double k) {
    if (a >= 1 || a <= -1) return a < 0;
    return (1 - a) * (1 - a) * (4 * (2 + a) - k * (1 - a) * (3 + a)) / (16 * (1 + k * a));
}

}  // namespace

TEST_CASE("a convolved ball is that of the closed form, to the tolerance that is stated", "[slow]") {
    double worst = 0;
    for (const double r : {0.1, 0.3, 0.6}) {
        const Convolved c(r, Density::sphere({1, 2, 3}, 1));
        const double exact = level([&](Vec3 x) { return share_of_sphere(x.x / r, r); }, Vec3(0.0), {1, 0, 0}, r);
        for (auto seed : seeds(300)) {
            CAPTURE(r, seed);
            Gen g(seed);
            const Vec3 n = glm::normalize(g.point(1));
            const double off = (c.level(Vec3(1, 2, 3) + n, n, r) - exact) / r;
            CHECK(std::abs(off) < round_convolution_tolerance);
            worst = std::max(worst, std::abs(off));
        }
    }
    CHECK(worst > 0.001);  // it is 0.0028; otherwise the stated tolerance could be less
}

TEST_CASE("flat faces stay where they are, and edges between them are as in the closed form") {
    const double r = 0.2;
    const Density block = Density::box(Vec3(0.0), {1, 1, 1}) + Density::box({0.4, 0, 0}, {1, 1.5, 1});
    const Convolved c(r, block | Density::sphere({5, 0, 0}, 0.5));
    const DensityTree tree = flatten_convolved(block, r);
    const auto exact = [&](Vec3 x) { return tree.at(x); };
    CHECK(std::abs(c.level({0.7, 0.5, 0}, {0, 0, -1}, r)) < 1e-9);  // on a face that both have in common
    double worst = 0;
    for (auto seed : seeds(300)) {
        CAPTURE(seed);
        Gen g(seed);
        // Points near a convex edge, a corner and the concave edge.
        const Vec3 corners[] = {{0, 0.5, 0}, {0, 0, 0}, {0.4, 1, 0.5}};
        const Vec3 normals[] = {{-1, 0, -1}, {-1, -1, -1}, {-1, 1, 0}};
        const int which = g.below(3);
        const Vec3 n = glm::normalize(normals[which]), x = corners[which] + 0.3 * r * g.point(1);
        const double off = (c.level(x, n, 2 * r) - level(exact, x, n, 2 * r)) / r;
        CHECK(std::abs(off) < round_convolution_tolerance);
        worst = std::max(worst, std::abs(off));
    }
    CHECK(worst > 0.0003);  // it is 0.0009
}

TEST_CASE("convolution has no tangent seams, where rounding bulges") {
    const double r = 0.2;
    const Density bar = Density::box({-2, -0.5, -1}, {0, 0.5, 1}) | Density::cylinder({0, 0, -1}, {0, 0, 1}, 0.5);
    const Convolved c(r, bar);
    const DensityTree rounded = flatten(bar, r);
    const Vec3 x(0, 0.5, 0), n(0, 1, 0);
    CHECK(level([&](Vec3 y) { return rounded.at(y); }, x, n, r) > 0.15 * r);
    // The surface lies between the plane, which stays, and the cylinder, which moves in by r²/8R.
    CHECK(c.level(x, n, r) < round_convolution_tolerance * r);
    CHECK(c.level(x, n, r) > -r * r / 4 - round_convolution_tolerance * r);
    CHECK(c.level({0.5, 0, 0}, {1, 0, 0}, r) == Approx(-r * r / 4).margin(0.01 * r));
}

TEST_CASE("what cannot be convolved is refused, and what vanishes is left to vanish") {
    const Density ball = Density::sphere(Vec3(0.0), 1);
    CHECK_THROWS_AS(convolved_round(0.1, ~ball, 0), NoRoundConvolution);
    CHECK_THROWS_AS(convolved_round(1e-5, ball, 0), NoRoundConvolution);
    CHECK(!convolved_round(0.1, ball & Density::box(Vec3(2.0), Vec3(3.0)), 0).node().field());
}
