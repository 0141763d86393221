// Bound CSG against Lobb's theorems and the Fréchet inequalities, at points on its planes, where the bounds are tight.
#include "bounds/csg_bounds.hpp"

#include "bounds/bounding_box.hpp"
#include "catch.hpp"
#include "plain_definition.hpp"
#include "random_case.hpp"

using namespace deburr;

namespace {

// Rounding error of ρ at a point x that is computed as the intersection of planes and so is off by a few ε.
double rounding(const DensityTree& tree, Vec3 x) {
    double least = infinity;
    for (const HalfSpace& h : tree.half_spaces)
        if (h.radius > 0) least = std::min(least, h.radius);
    return 4 * epsilon * (1 + (least < infinity ? glm::length(x) / least : 0)) * double(tree.half_spaces.size());
}

struct Tally {
    int conclusive = 0;  // points about which the bound says something
    int tight = 0;       // those of them where |ρ − t| < 10⁻⁹
};

// Checks that x ∉ O implies ρ ≤ t, at points where O's planes meet.
void check_outer(const DensityTree& tree, double t, Gen& g, Tally& tally) {
    const BoundCsg bound = outer_bound(tree, t);
    for (int k = 0; k < 4; ++k) {
        const Vec3 x = g.tight_point(bound, true);
        if (bound.contains(x)) continue;
        const double rho = plain::density(tree, x);
        ++tally.conclusive;
        tally.tight += std::abs(rho - t) < 1e-9;
        REQUIRE(rho <= t + rounding(tree, x));
    }
}

void check_inner(const DensityTree& tree, double t, Gen& g, Tally& tally) {
    const BoundCsg bound = inner_bound(tree, t);
    for (int k = 0; k < 4; ++k) {
        const Vec3 x = g.tight_point(bound, false);
        if (!bound.contains(x)) continue;
        const double rho = plain::density(tree, x);
        ++tally.conclusive;
        tally.tight += std::abs(rho - t) < 1e-9;
        REQUIRE(rho >= t - rounding(tree, x));
    }
}

template <class Make>
Tally over_cases(int count, bool outer, Make make) {
    Tally tally;
    for (auto seed : seeds(count)) {
        CAPTURE(seed);
        Gen g(seed);
        const DensityTree tree = flatten(make(g), g.chance(0.1) ? 0.0 : g.between(0.05, 0.5));
        const double t = g.threshold();
        outer ? check_outer(tree, t, g, tally) : check_inner(tree, t, g, tally);
    }
    return tally;
}

Density leaf(Gen& g) { return Density::half_space(g.normal(), g.between(-0.5, 0.5)); }

}  // namespace

TEST_CASE("Lobb theorem 1: an intersection at t is an outer bound of a product") {
    const Tally tally = over_cases(5'000, true, [](Gen& g) { return leaf(g) * leaf(g); });
    CHECK(tally.conclusive > 4'000);
    CHECK(tally.tight > 400);
}

TEST_CASE("Lobb theorem 2: a union at t/2 is an outer bound of a sum") {
    const Tally tally = over_cases(5'000, true, [](Gen& g) { return leaf(g) + leaf(g); });
    CHECK(tally.conclusive > 4'000);
    CHECK(tally.tight > 400);
}

TEST_CASE("Lobb theorem 3: O(t) minus I(1 - t) is an outer bound of a difference") {
    const Tally tally = over_cases(5'000, true, [](Gen& g) { return leaf(g) - leaf(g); });
    CHECK(tally.conclusive > 4'000);
    CHECK(tally.tight > 400);
}

TEST_CASE("Lobb theorem 4: a union at t is an inner bound of a sum") {
    // The appendix prints "outer" here and in theorems 5 and 6; its proofs are for inner bounds.
    const Tally tally = over_cases(5'000, false, [](Gen& g) { return leaf(g) + leaf(g); });
    CHECK(tally.conclusive > 4'000);
    CHECK(tally.tight > 400);
}

TEST_CASE("Lobb theorem 5: an intersection at sqrt(t) is an inner bound of a product") {
    const Tally tally = over_cases(5'000, false, [](Gen& g) { return leaf(g) * leaf(g); });
    CHECK(tally.conclusive > 4'000);
    CHECK(tally.tight > 400);
}

TEST_CASE("Lobb theorem 6: I(t) minus O(0) is an inner bound of a difference") {
    const Tally tally = over_cases(5'000, false, [](Gen& g) { return leaf(g) - leaf(g); });
    CHECK(tally.conclusive > 2'000);
    CHECK(tally.tight > 200);
}

TEST_CASE("Frechet: outer bounds of conjunctions, disjunctions and complements, whatever they share") {
    for (const bool outer : {true, false}) {
        const Tally tally = over_cases(5'000, outer, [](Gen& g) {
            const Density a = leaf(g), b = g.chance(0.3) ? a : leaf(g);  // operands may be fully dependent
            return g.chance(0.4) ? a & b : g.chance(0.7) ? a | b : ~a & b;
        });
        CHECK(tally.conclusive > 4'000);
        CHECK(tally.tight > 300);
    }
}

TEST_CASE("bounds of whole trees hold at any threshold") {
    for (const bool outer : {true, false}) {
        int deep = 0;
        const Tally tally = over_cases(3'000, outer, [&](Gen& g) {
            for (;;) {
                const Density d = g.chance(0.5) ? g.boolean(2) : g.legal(2);
                if (!bounds_hold(flatten(d, 0.1), Box::everything())) continue;
                deep += d.node().leaves > 8;
                return d;
            }
        });
        CHECK(tally.conclusive > 2'000);
        CHECK(deep > 500);
    }
}

TEST_CASE("a ray outside its search spans does not change sides") {
    int spans = 0;
    for (auto seed : seeds(4'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const Density d = g.chance(0.5) ? g.boolean(2) : g.legal(1);
        const DensityTree tree = flatten(d, g.radius());
        if (!bounds_hold(tree, Box::everything())) continue;
        const BoundCsg outer = outer_bound(tree, 0.5, 1e-12), inner = inner_bound(tree, 0.5, 1e-12);
        const Vec3 o = g.point(3), to = glm::normalize(g.point(0.7) - o);
        SearchSpans search;
        double last = 0;
        for (const Span s : search.between(outer, inner, o, to, 0, 10)) {
            ++spans;
            REQUIRE(s.lo <= s.hi);
            REQUIRE(s.lo >= last);
            const bool side = plain::density(tree, o + to * (0.5 * (last + s.lo))) > 0.5;
            for (int k = 0; k < 6; ++k) {
                const double t = last + (s.lo - last) * (k + 0.5) / 6;
                REQUIRE((plain::density(tree, o + to * t) > 0.5) == side);
            }
            last = s.hi;
        }
    }
    CHECK(spans > 1'500);
}

TEST_CASE("a bounding box holds the solid, and is tight for a tilted block") {
    int inside = 0;
    for (auto seed : seeds(3'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const SolidTree tree = flatten(g.solid(1));
        const Box box = bounding_box(tree);
        for (int k = 0; k < 10; ++k) {
            const Vec3 x = g.point(2);
            if (!plain::contains(tree, x)) continue;
            ++inside;
            REQUIRE(box.contains(x));
        }
    }
    CHECK(inside > 2'000);
    const double s = std::sqrt(0.5);
    const Affine turned{Mat3(s, s, 0, -s, s, 0, 0, 0, 1), Vec3(5, 0, 0)};
    const Box box = bounding_box(flatten(Density::box(Vec3(0), Vec3(1)), 0.1, turned));
    CHECK(glm::length(box.lo - Vec3(5 - s, 0, 0)) < 1e-7);
    CHECK(glm::length(box.hi - Vec3(5 + s, 2 * s, 1)) < 1e-7);
    // Nested sums are bounded too: their operands are not provably in [0, 1], but have the box of where they are not 0.
    Density row = Density::box(Vec3(0), Vec3(1));
    for (int i = 1; i < 64; ++i) row = row + Density::box({i, 0, 0}, {i + 1.0, 1, 1});
    CHECK(bounding_box(flatten(row, 0.1)).finite());
}
