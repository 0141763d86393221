// Densities and their flat trees: values and gradients against the plain definition, and the laws of Boolean densities.
#include "bounds/density_tree.hpp"

#include "bounds/local_density.hpp"
#include "catch.hpp"
#include "plain_definition.hpp"
#include "random_case.hpp"

using namespace deburr;

namespace {

Density slab_box(double x0, double x1, double y0 = 0, double y1 = 1) { return Density::box({x0, y0, 0}, {x1, y1, 1}); }

double at(const Density& d, double r, Vec3 x) { return flatten(d, r).at(x); }

}  // namespace

TEST_CASE("a flat tree evaluates to the definition, whatever the operators") {
    int varying = 0;
    for (auto seed : seeds(6'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const Density d = g.chance(0.5) ? g.boolean(3) : g.arithmetic(3);
        const DensityTree tree = flatten(d, g.radius(), g.chance(0.3) ? g.map() : Affine{});
        for (int k = 0; k < 3; ++k) {
            const Vec3 x = g.near(tree);
            if (on_a_jump(tree, x)) continue;
            const double rho = tree.at(x);
            REQUIRE(std::abs(rho - plain::density(tree, x)) < 1e-12);
            varying += rho > 0 && rho < 1;
        }
    }
    CHECK(varying > 2'000);
}

TEST_CASE("the gradient is the density's derivative") {
    int checked = 0;
    for (auto seed : seeds(4'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const DensityTree tree = flatten(g.chance(0.5) ? g.boolean(2) : g.arithmetic(2), g.between(0.1, 0.5));
        const LocalDensity local(tree);
        const Vec3 x = g.near(tree);
        const auto [value, gradient] = local.gradient_at(x);
        bool sharp_nearby = false;
        for (const HalfSpace& h : tree.half_spaces) sharp_nearby |= h.radius < 0.01 && std::abs(h.distance(x)) < 0.02;
        if (sharp_nearby) continue;
        for (int k = 0; k < 3; ++k) {
            Vec3 step(0.0);
            step[k] = 1e-6;
            REQUIRE(std::abs((tree.at(x + step) - tree.at(x - step)) / 2e-6 - gradient[k]) < 1e-3);
        }
        checked += glm::length(gradient) > 0.01;
    }
    CHECK(checked > 1'000);
}

TEST_CASE("a Boolean density lies in [0, 1] and depends on the function, not on how it is written") {
    int varying = 0;
    for (auto seed : seeds(4'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const Density a = g.boolean(1), b = g.boolean(1), c = g.part();
        const double r = g.between(0.05, 0.6);
        const Vec3 x = g.near(flatten((a | b) & ~c, r));
        const double rho = at((a | b) & ~c, r, x);
        REQUIRE((rho >= -1e-15 && rho <= 1 + 1e-15));
        REQUIRE(std::abs(rho - at(~((~a & ~b) | c), r, x)) < 1e-12);         // De Morgan
        REQUIRE(std::abs(rho - at((a & ~c) | (~c & b), r, x)) < 1e-12);      // distributive law
        REQUIRE(std::abs(at(a | (a & b), r, x) - at(a & a, r, x)) < 1e-12);  // absorption
        varying += rho > 0.01 && rho < 0.99;
    }
    CHECK(varying > 600);
}

TEST_CASE("below a Boolean operator + * - read as or, and, and-not") {
    for (auto seed : seeds(500)) {
        CAPTURE(seed);
        Gen g(seed);
        const Density a = g.box(), b = g.box(), c = g.box();
        const Vec3 x = g.point(1);
        const double r = g.between(0.05, 0.5);
        REQUIRE(at((a + b) & c, r, x) == Approx(at((a | b) & c, r, x)).margin(1e-13));
        REQUIRE(at((a - b) | c, r, x) == Approx(at((a & ~b) | c, r, x)).margin(1e-13));
    }
}

TEST_CASE("flush faces that overlap, touch or are cut away stay flat to 1e-14") {
    const double r = 0.2;
    const Density over = slab_box(0, 2) | slab_box(1, 3), touch = slab_box(0, 1) | slab_box(1, 3);
    const Density cut = slab_box(0, 3) & ~Density::box({1, -1, -1}, {2, 1, 0.5});
    const Density nested = slab_box(0, 3) | slab_box(0.5, 1) | slab_box(0.7, 2.2);
    for (double x = 0.5; x <= 2.5; x += 1.0 / 64) {
        CHECK(std::abs(at(over, r, {x, 1, 0.5}) - 0.5) < 1e-14);
        CHECK(std::abs(at(touch, r, {x, 1, 0.5}) - 0.5) < 1e-14);
        CHECK(std::abs(at(nested, r, {x, 1, 0.5}) - 0.5) < 1e-14);
        // The pocket's rim is rounded, but beyond one radius from it the top face is unchanged.
        if (std::abs(x - 1.5) > 0.5 + r) CHECK(std::abs(at(cut, r, {x, 1, 0.75}) - 0.5) < 1e-14);
    }
    // docs/design.md, Boolean densities, gives these figures for the papers' sum and a product of equal half-spaces.
    const Density h = Density::half_space({0, 1, 0}, 1);
    CHECK(at(slab_box(0, 2) + slab_box(1, 3), r, {1.5, 1 + 0.347 * r, 0.5}) == Approx(0.5).margin(2e-3));
    CHECK(at(h * h, r, {0, 1 - 0.284 * r, 0}) == Approx(0.5).margin(2e-3));
    CHECK(std::abs(at(h & h, r, {0, 1, 0}) - 0.5) < 1e-15);
}

TEST_CASE("where the papers' operators are legal and planes 2r apart, both readings agree") {
    const double r = 0.1;
    const Density cube = slab_box(0, 1), hole = Density::box({0.3, -0.5, 0.3}, {0.7, 1.5, 0.7});
    const Density top = Density::half_space({0, 1, 0}, 1), bottom = Density::half_space({0, -1, 0}, 0);
    Gen g(1);
    for (int i = 0; i < 2'000; ++i) {
        const Vec3 x = Vec3(0.5) + g.point(0.7);
        const double legal = at(cube - top * bottom * Density::box({0.3, -5, 0.3}, {0.7, 5, 0.7}), r, x);
        REQUIRE(std::abs(legal - at(cube & ~hole, r, x)) < 1e-12);
    }
}

TEST_CASE("axis-parallel Boolean densities are true convolutions with three ball profiles") {
    // The reference is a midpoint rule over the kernel ¾(1 − u²), u in [−1, 1] in units of r, along each axis, for a
    // model with flush, overlapping and thin parts.
    const double r = 0.3;
    const auto inside = [](Vec3 p) {
        const auto in = [&](Vec3 lo, Vec3 hi) { return Box{lo, hi}.contains(p); };
        return (in({0, 0, 0}, {1, 1, 1}) || in({0.6, 0, 0}, {2, 1, 1})) && !in({0.9, 0.5, -1}, {1.0, 2, 2});
    };
    const Density model = (slab_box(0, 1) | slab_box(0.6, 2)) & ~Density::box({0.9, 0.5, -1}, {1.0, 2, 2});
    constexpr int n = 80;
    Gen g(7);
    for (int k = 0; k < 12; ++k) {
        const Vec3 x{g.between(-0.2, 2.2), g.between(-0.2, 1.2), g.between(-0.2, 1.2)};
        double sum = 0;
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j)
                for (int m = 0; m < n; ++m) {
                    const Vec3 u = (Vec3(i, j, m) + 0.5) * (2.0 / n) - 1.0;
                    const Vec3 w = 0.75 * (1.0 - u * u) * (2.0 / n);
                    if (inside(x + r * u)) sum += w.x * w.y * w.z;
                }
        CHECK(at(model, r, x) == Approx(sum).margin(0.03));
    }
}

TEST_CASE("a radius fixed inside holds against those outside, and is not scaled by a density's map") {
    const Density d = (Density::half_space({1, 0, 0}, 0).radius(0.1) * Density::half_space({0, 1, 0}, 0))
                          .radius(0.2)
                          .transformed({Mat3(3.0), Vec3(0)});
    const DensityTree tree = flatten(d, 0.5);
    CHECK(tree.half_spaces[0].radius == 0.1);
    CHECK(tree.half_spaces[1].radius == 0.2);
    // A solid's map does scale it: the density becomes x ↦ ρ(A⁻¹x).
    const DensityTree carried = flatten(d, 0.5, {Mat3(3.0), Vec3(0)});
    CHECK(carried.half_spaces[0].radius == Approx(0.3));
}

TEST_CASE("carried density fields equal the field at the point that is carried back") {
    int varying = 0;
    for (auto seed : seeds(3'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const Density d = g.boolean(2);
        const Affine map = g.map();
        const double r = g.between(0.05, 0.5);
        const Vec3 x = g.near(flatten(d, r));
        if (on_a_jump(flatten(d, r), x)) continue;
        const double rho = flatten(d, r, map).at(map(x));
        REQUIRE(std::abs(rho - at(d, r, x)) < 1e-9);
        varying += rho > 0 && rho < 1;
    }
    CHECK(varying > 800);
}

TEST_CASE("chains as long as a scene's loops neither recurse when flattened nor when they die") {
    Density chain = slab_box(0, 1);
    for (int i = 1; i < 100'000; ++i) {
        const Density next = Density::half_space({1, 0, 0}, i);
        chain = i % 3 == 0   ? (chain | next).transformed({Mat3(1.0), Vec3(0)})
                : i % 3 == 1 ? chain & next
                             : chain - next;
    }
    CHECK(flatten(chain, 0.1).half_spaces.size() == 100'005);
    Density doubled = slab_box(0, 1);
    for (int i = 0; i < 60; ++i) doubled = doubled | doubled;
    CHECK_THROWS_AS(flatten(doubled, 0.1), std::length_error);
}
