// True convolution as a density like any other: its bounds, ranges and pruning. Also what Lobb says about the
// difference between quasi-convolution and true convolution.
#include "bounds/bounding_box.hpp"
#include "bounds/local_density.hpp"
#include "bounds/solid_range.hpp"
#include "catch.hpp"
#include "plain_definition.hpp"
#include "random_case.hpp"

using namespace deburr;

namespace {

double exact(const Density& d, Vec3 x, double r) { return flatten_convolved(d, r).at(x); }
double quasi(const Density& d, Vec3 x, double r) { return flatten(d, r).at(x); }

DensityTree random_convolution(Gen& g) {
    return flatten_convolved(g.boolean(g.below(3)), g.between(0.05, 0.6), g.chance(0.3) ? g.map() : Affine{});
}

}  // namespace

TEST_CASE("M, L and G bound a true convolution, its slope and its slope's slope on a segment") {
    int exercised = 0, close = 0, curved = 0;
    for (auto seed : seeds(4'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const DensityTree whole = random_convolution(g);
        const Vec3 origin = g.near(whole), direction = g.direction() * g.between(0.5, 2);
        const double length = std::pow(10.0, g.between(-3, 0));
        const Vec3 end = origin + length * direction;
        const bool local = g.chance(0.5);
        const LocalDensity density(local ? prune(whole, Box{glm::min(origin, end), glm::max(origin, end)}).tree
                                         : whole);
        if (density.half_spaces().empty()) continue;
        RayDensity ray;
        ray.set(density, origin, direction);
        const auto [M, L, G] = ray.bounds(0, length);
        const double h = 1e-5 * length;
        for (int k = 0; k < 8; ++k) {
            const double t = h + (length - 2 * h) * (k / 7.0);
            const auto [value, slope] = ray.at(t);
            REQUIRE(std::abs(value) <= M);
            REQUIRE(std::abs(slope) <= L * (1 + 1e-12) + 1e-12);
            const double curve = std::abs(ray.at(t + h).slope - ray.at(t - h).slope) / (2 * h);
            REQUIRE(curve <= G * (1 + 1e-4) + 1e-9 / h);
            exercised += std::abs(slope) > 1e-3;
            close += std::abs(slope) > 0.99 * L && L > 0;
            curved += curve > 0.5 * G && G > 0;
        }
    }
    CHECK(exercised > 10'000);
    CHECK(close > 1'000);
    CHECK(curved > 1'000);
}

TEST_CASE("a true convolution stays within its range over a box, and pruned to a box it is the same there") {
    int straddling = 0, tightened = 0;
    for (auto seed : seeds(2'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const DensityTree tree = random_convolution(g);
        const Vec3 c = g.near(tree),
                   half = std::pow(10.0, g.between(-3, -0.5)) * Vec3(g.between(0, 1), g.between(0, 1), g.between(0, 1));
        const Box box{c - half, c + half};
        const Pruned pruned = prune(tree, box);
        const LocalDensity local(pruned.tree), whole(tree);
        const Range range = local.range(box);
        straddling += range.lo < range.hi;
        tightened += range.hi - range.lo < pruned.range.hi - pruned.range.lo - 1e-9;
        for (int k = 0; k < 10; ++k) {
            Vec3 x = c + half * g.point(1);
            if (k < 8)
                for (int axis = 0; axis < 3; ++axis) x[axis] = k >> axis & 1 ? box.lo[axis] : box.hi[axis];
            const double rho = whole.at(x);
            REQUIRE(rho >= range.lo - 1e-12);
            REQUIRE(rho <= range.hi + 1e-12);
            REQUIRE(rho >= pruned.range.lo - 1e-12);
            REQUIRE(rho <= pruned.range.hi + 1e-12);
            REQUIRE(std::abs(local.at(x) - rho) < 2e-8);
        }
    }
    CHECK(straddling > 500);
    CHECK(tightened > 200);
}

TEST_CASE("outer and inner bounds by the Frechet inequalities hold for true convolution") {
    int outside = 0, inside = 0;
    for (auto seed : seeds(3'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const DensityTree tree = random_convolution(g);
        const double t = g.threshold();
        const BoundCsg outer = outer_bound(tree, t), inner = inner_bound(tree, t);
        const Vec3 x = g.tight_point(outer, true), y = g.tight_point(inner, false);
        if (!outer.contains(x)) {
            ++outside;
            REQUIRE(tree.at(x) <= t + 1e-12);
        }
        if (inner.contains(y)) {
            ++inside;
            REQUIRE(tree.at(y) >= t - 1e-12);
        }
        const Box box = bounding_box(tree);
        const Vec3 z = g.near(tree);
        if (tree.at(z) > 0.5) REQUIRE(inflated(box, 1e-9).contains(z));
    }
    CHECK(outside > 500);
    CHECK(inside > 500);
}

TEST_CASE("a convolved solid is carried along by any map") {
    int varying = 0;
    for (auto seed : seeds(500)) {
        CAPTURE(seed);
        Gen g(seed);
        const Density d = g.boolean(1);
        if (d.has_radius()) continue;  // all of a convolution has one radius
        const double r = g.between(0.1, 0.5);
        const Affine map = g.map();
        const SolidTree still = flatten(Solid::convolved(r, d)),
                        moved = flatten(Solid::convolved(r, d).transformed(map));
        const DensityTree &a = still.leaves[0].density, &b = moved.leaves[0].density;
        const Vec3 x = g.near(a);
        CHECK(std::abs(a.at(x) - b.at(map(x))) < 1e-12);
        const Vec3 there = b.gradient_at(map(x)).gradient, here = glm::transpose(map.linear) * there;
        CHECK(glm::length(here - a.gradient_at(x).gradient) < 1e-6 / r);
        varying += glm::length(here) > 0.1;
    }
    CHECK(varying > 100);
}

// ---- Lobb §2.3.1 ---------------------------------------------------------------------------------

TEST_CASE("Lobb 2.3.1 (a): a product is exact where the filter lies outside of either factor") {
    int met = 0, compound = 0;
    for (auto seed : seeds(4'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const Density a = g.box(), b = Density::half_space(g.normal(), g.between(-0.5, 0.5)), c = g.box();
        const double r = g.between(0.05, 0.4);
        const Vec3 x = g.near(flatten(a, r));
        if (exact(b, x, r) == 0) {
            CHECK(exact(a * b, x, r) == 0);
            CHECK(quasi(a * b, x, r) == 0);
            met += exact(a, x, r) > 0;
        }
        // This does not hold if a factor is itself a product: a filter beyond the factor's edge may meet both of its
        // planes and nothing of the wedge between them.
        if (exact(c, x, r) == 0) {
            CHECK(exact(a * c, x, r) == 0);
            CHECK(quasi(a * c, x, r) < 0.01);
            compound += quasi(a * c, x, r) > 0;
        }
    }
    CHECK(met > 300);
    CHECK(compound > 10);
}

TEST_CASE("Lobb 2.3.1 (b): a product is exact where the filter lies inside of one factor") {
    int met = 0;
    for (auto seed : seeds(4'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const Density a = Density::half_space(g.normal(), g.between(-0.5, 0.5)), b = g.box();
        const double r = g.between(0.02, 0.15);
        const Vec3 x = g.near(flatten(a, r), 0.6);
        if (exact(b, x, r) < 1) continue;
        CHECK(std::abs(exact(a * b, x, r) - exact(a, x, r)) < 1e-15);
        CHECK(std::abs(quasi(a * b, x, r) - exact(a * b, x, r)) < 1e-15);
        met += exact(a, x, r) > 0 && exact(a, x, r) < 1;
    }
    CHECK(met > 50);
}

TEST_CASE("Lobb 2.3.1 (c), (d): a product is exact on a right-angled edge and in a right-angled corner") {
    for (auto seed : seeds(1'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const Vec3 u = g.direction(), v = glm::normalize(glm::cross(u, g.direction())), w = glm::cross(u, v),
                   x = g.point();
        const double r = g.between(0.1, 1);
        const Density a = Density::half_space(u, glm::dot(u, x)), b = Density::half_space(v, glm::dot(v, x)),
                      c = Density::half_space(w, glm::dot(w, x));
        CHECK(exact(a * b, x, r) == Approx(0.25).epsilon(1e-13));
        CHECK(quasi(a * b, x, r) == Approx(0.25).epsilon(1e-13));
        const Vec3 along = x + g.between(-3, 3) * w;
        CHECK(exact(a * b, along, r) == Approx(0.25).epsilon(1e-13));
        CHECK(exact(a * b * c, x, r) == Approx(0.125).epsilon(1e-13));
        CHECK(quasi(a * b * c, x, r) == Approx(0.125).epsilon(1e-13));
    }
}

TEST_CASE("Lobb 2.3.1: off a right-angled edge a product is not exact, and a doubled half-space moves in") {
    const Density edge = Density::half_space({1, 0, 0}, 0) * Density::half_space({0, 1, 0}, 0);
    CHECK(std::abs(exact(edge, {-0.3, -0.3, 0}, 1) - quasi(edge, {-0.3, -0.3, 0}, 1)) > 1e-3);
    // "The entire isosurface is inside the planes by about one quarter of the filter radius."
    const Density twice = Density::half_space({1, 0, 0}, 0) * Density::half_space({1, 0, 0}, 0);
    const double in = -displacement(std::sqrt(0.5));
    CHECK(in == Approx(0.28).margin(0.005));
    CHECK(quasi(twice, {-in, 0, 0}, 1) == Approx(0.5));
    CHECK(exact(twice, {0, 0, 0}, 1) == Approx(0.5));
    // "Two abutting antiparallel halfspaces would evaluate to 0.25 on the common plane rather than 0."
    const Density nothing = Density::half_space({1, 0, 0}, 0) * Density::half_space({-1, 0, 0}, 0);
    CHECK(quasi(nothing, Vec3(0), 1) == Approx(0.25));
    CHECK(exact(nothing, Vec3(0), 1) == 0);
}
