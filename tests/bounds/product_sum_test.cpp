// Densities multiplied out into sums of products: values, gradients and crossings against the density itself.
#include "bounds/product_sum.hpp"

#include "catch.hpp"
#include "plain_definition.hpp"
#include "random_case.hpp"
#include "round_cell.hpp"

using namespace deburr;

namespace {

constexpr double root_tolerance = 1e-14;

// A density pruned to a small box, as in a cell; `sum` is empty if it cannot be multiplied out.
struct PrunedDensity {
    DensityTree tree;
    std::optional<LocalDensity> density;
    std::optional<ProductSum> sum;

    explicit PrunedDensity(Gen& g) {
        const Density d = g.chance(0.4) ? g.boolean(2) : g.chance(0.6) ? g.legal(2) : g.arithmetic(2);
        const DensityTree whole = flatten(d, g.between(0.05, 0.6));
        const Vec3 lo = g.near(whole);
        tree = prune(whole, {lo, lo + Vec3(g.between(0.05, 0.6))}).tree;
        density.emplace(tree);
        if (density->half_spaces().size() > 1) sum = ProductSum::of(*density, 1e-12);
    }
};

Vec3 direction_to(Gen& g, const PrunedDensity& c, Vec3 o) {
    const Vec3 direction = glm::normalize(g.near(c.tree) - o);
    if (!g.chance(0.3)) return direction;
    // Nearly along one of the planes.
    const Vec3 n = c.tree.half_spaces[g.below(int(c.tree.half_spaces.size()))].normal;
    const Vec3 flat = direction - n * glm::dot(direction, n);
    return glm::length(flat) > 1e-3 ? glm::normalize(flat + n * std::pow(10.0, g.between(-9, -1))) : direction;
}

}  // namespace

TEST_CASE("a density multiplied out has the density's values and gradients") {
    int recognized = 0, with_constant = 0, several = 0;
    for (auto seed : seeds(8'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const PrunedDensity c(g);
        if (!c.sum) continue;
        ++recognized;
        with_constant += c.sum->constant() != 0;
        several += c.sum->terms().size() > 2;
        const Vec3 o = g.point();
        ProductSumRay ray;
        ray.set(*c.sum, o, g.direction());
        const ValueGradient want = c.density->gradient_at(o);
        REQUIRE(want.value == Approx(plain::density(c.tree, o)).margin(1e-12));
        if (std::abs(want.value - 0.5) > 1e-12) REQUIRE(ray.inside(0) == (want.value > 0.5));
        REQUIRE(glm::length(ray.gradient(0) - want.gradient) < 1e-11 * (1 + glm::length(want.gradient)));
    }
    CHECK(recognized > 2'000);
    CHECK(with_constant > 250);  // compilers differ in the order of operands, so in the cases; 294 with clang++
    CHECK(several > 300);
}

TEST_CASE("a density with round parts multiplied out has the density's sides and gradients") {
    int recognized = 0, several = 0, round = 0;
    for (auto seed : seeds(6'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const test::RoundCell c(g, 1 + g.below(4));
        if (!c.local) continue;
        const auto sum = ProductSum::of(*c.local, 1e-12);
        if (!sum) continue;
        ++recognized;
        several += sum->terms().size() > 1;
        round += !sum->rounds().empty();
        for (int k = 0; k < 5; ++k) {
            const Vec3 x = c.point(g);
            ProductSumRay ray;
            ray.set(*sum, x, g.direction());
            const double want = c.whole.plain.density(x, c.whole.radius);
            if (std::abs(want - 0.5) > 1e-11) REQUIRE(ray.inside(0) == (want > 0.5));
            const ValueGradient at = c.pruned->at(x);
            REQUIRE(glm::length(ray.gradient(0) - at.gradient) < 1e-10 * (1 + glm::length(at.gradient)));
        }
    }
    CHECK(recognized > 900);
    CHECK(several > 200);
    CHECK(round > 700);
}

TEST_CASE("slopes between two points of a ray are within the range that the points' products allow") {
    int exercised = 0, close = 0;
    for (auto seed : seeds(20'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const PrunedDensity c(g);
        if (!c.sum) continue;
        const Vec3 o = g.point(2);
        const Vec3 direction = direction_to(g, c, o);
        ProductSumRay ray;
        RayDensity plain_ray;
        ray.set(*c.sum, o, direction);
        plain_ray.set(*c.density, o, direction);
        double t0 = 0, t1 = 6;
        if (!ray.narrow(t0, t1)) continue;
        RootCounters counters;
        const double from = t0 + (t1 - t0) * g.number(), length = (t1 - from) * std::pow(10.0, g.between(-3, 0));
        ProductSumRay::Point a, b;
        ray.evaluate(from, counters, a);
        ray.evaluate(from + length, counters, b);
        REQUIRE(a.f == Approx(plain_ray.at(from).value - 0.5).margin(1e-12));
        const auto [lo, hi] = ray.slopes(a, b);
        const double slack = 1e-11 * (1 + hi - lo);
        for (int k = 0; k <= 20; ++k) {
            const double slope = plain_ray.at(from + length * (k / 20.0)).slope;
            REQUIRE(slope >= lo - slack);
            REQUIRE(slope <= hi + slack);
            exercised += std::abs(slope) > 1e-3;
            close += std::abs(slope) > 1e-3 && (slope < lo + 0.1 * (hi - lo) || slope > hi - 0.1 * (hi - lo));
        }
    }
    CHECK(exercised > 20'000);
    CHECK(close > 1'000);
}

TEST_CASE("a sum's crossings are those of the search by M, L and G, whatever the ray") {
    int total = 0, several = 0, grazing = 0;
    RootCounters ours, theirs;
    for (auto seed : seeds(30'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const PrunedDensity c(g);
        if (!c.sum) continue;
        const Vec3 o = g.chance(0.3) ? g.near(c.tree) : g.point(2);
        const Vec3 direction = direction_to(g, c, o);
        const double t0 = g.chance(0.5) ? 0 : g.between(0, 1), t1 = g.chance(0.1) ? infinity : t0 + g.between(0, 6);
        RayDensity plain_ray;
        plain_ray.set(*c.density, o, direction);
        std::vector<RootCrossing> want, got, coarse;
        const auto into = [](std::vector<RootCrossing>& all) {
            return [&all](RootCrossing x) {
                all.push_back(x);
                return true;
            };
        };
        RootFinder({Criterion::exact, root_tolerance}, theirs).crossings(plain_ray, t0, std::min(t1, 1e11), into(want));
        ProductSumRay ray;
        ray.set(*c.sum, o, direction);
        ray.crossings(t0, t1, root_tolerance, false, ours, into(got));
        RootCounters counters;
        ray.crossings(t0, t1, root_tolerance, true, counters, into(coarse));
        REQUIRE(coarse.size() == got.size());
        // Both searches may overlook a dip of 10⁻⁹, and so may a ray that starts on the surface.
        const auto near_zero = [&](double t) {
            return std::abs(plain_ray.at(t).slope) < 1e-4 || std::abs(t - t0) < 1e-9 || std::abs(t - t1) < 1e-9;
        };
        if (want.size() != got.size()) {
            bool explained = false;
            for (const RootCrossing& x : want) explained |= near_zero(x.t);
            for (const RootCrossing& x : got) explained |= near_zero(x.t);
            ++grazing;
            REQUIRE(explained);
            continue;
        }
        for (std::size_t i = 0; i < want.size(); ++i) {
            REQUIRE(got[i].entering == want[i].entering);
            REQUIRE(coarse[i].entering == want[i].entering);
            const double slope = std::abs(plain_ray.at(want[i].t).slope);
            if (slope > 1e-6) REQUIRE(std::abs(got[i].t - want[i].t) <= (1 + want[i].t) * (2e-13 + 1e-13 / slope));
        }
        total += int(want.size());
        several += want.size() > 1;
    }
    CAPTURE(ours.evaluations, theirs.evaluations);
    CHECK(2 * ours.evaluations < theirs.evaluations);
    CHECK(total > 2'000);
    CHECK(several > 500);
    CHECK(grazing < 100);
}

TEST_CASE("a ray in the plane of a sum's flush face is done soon") {
    const Density sum = Density::box({0, 0, 0}, {1, 1, 1}) + Density::box({1, 0, 0}, {2, 1, 1});
    for (const double r : {1e-3, 0.1, 0.4})
        for (const double height : {1.0, 1 + 1e-16, 1 - 1e-12, 1 + 1e-9}) {
            CAPTURE(r, height);
            const LocalDensity local(flatten(sum, r));
            const auto products = ProductSum::of(local, 1e-12);
            REQUIRE(products);
            ProductSumRay ray;
            ray.set(*products, {5, height, 0.5}, {-1, 0, 0});
            RootCounters counters;
            int crossings = 0;
            ray.crossings(0, 8, root_tolerance, false, counters, [&](RootCrossing) { return ++crossings; });
            CHECK(counters.evaluations < 1'000'000);
            if (height >= 1) CHECK(crossings == 0);
        }
}

TEST_CASE("multiplied out, nested half-spaces that do not vary in the same place are one product") {
    const auto slab = [](double thickness) {
        return Density::half_space({1, 0, 0}, thickness) & ~Density::half_space({1, 0, 0}, 0) &
               Density::half_space({0, 1, 0}, 0);
    };
    const auto terms = [](const Density& d, double r) { return LocalDensity(flatten(d, r)).as_sum(8)->terms.size(); };
    CHECK(terms(slab(0.5), 0.25) == 1);
    CHECK(terms(slab(0.5), 0.26) == 2);
    // In a product F·G of parallel planes, a factor that is 1 where the other varies is dropped; a product of disjoint
    // half-spaces vanishes.
    const Density narrow = Density::half_space({1, 0, 0}, 0), wide = Density::half_space({1, 0, 0}, 1);
    const Density other = Density::half_space({-1, 0, 0}, -1);
    CHECK(LocalDensity(flatten(narrow * wide, 0.5)).as_sum(1)->terms.at(0).factors.size() == 1);
    CHECK(LocalDensity(flatten(narrow * wide, 0.6)).as_sum(1)->terms.at(0).factors.size() == 2);
    CHECK(LocalDensity(flatten(narrow * other, 0.5)).as_sum(1)->terms.empty());
    CHECK(LocalDensity(flatten(narrow * other, 0.6)).as_sum(1)->terms.size() == 1);
}
