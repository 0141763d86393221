// Densities that are a product, or 1 minus a product: how they are recognized, and where rays cross them.
#include "bounds/convex_density.hpp"

#include "bounds/root_finder.hpp"
#include "catch.hpp"
#include "plain_definition.hpp"
#include "random_case.hpp"

using namespace deburr;

namespace {

constexpr double scale = 4;
constexpr double t_tolerance = 1e-14;

double value(const ConvexDensity& d, Vec3 x) {
    double P = 1;
    for (std::size_t i = 0; i < d.planes.size(); ++i) {
        const double alpha = glm::dot(d.planes[i].slope, x) + d.planes[i].base;
        const bool sharp = i + std::size_t(d.sharp) >= d.planes.size();
        P *= sharp ? (alpha <= 0 ? 1 : 0) : plain::profile(alpha);
    }
    return d.complement ? 1 - P : P;
}

// A product of half-spaces that meet within a few radii, so that several of them vary together.
Density product(Gen& g, int factors) {
    std::vector<Density> all;
    for (int i = 0; i < factors; ++i) {
        Density d = Density::half_space(g.normal(), g.between(-0.2, 0.4));
        if (g.chance(0.3)) d = d.radius(g.between(0.02, 0.6));
        all.push_back(d);
    }
    return Density::product(all);
}

}  // namespace

TEST_CASE("log F is concave, and so is log of any product along any line") {
    int close = 0;
    for (auto seed : seeds(20'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const int factors = 1 + g.below(4);
        std::vector<double> a, b;
        for (int i = 0; i < factors; ++i) {
            a.push_back(g.between(-1.5, 1.5));
            b.push_back(g.between(-2, 2));
        }
        const auto P = [&](double t) {
            double p = 1;
            for (std::size_t i = 0; i < a.size(); ++i) p *= plain::profile(a[i] + b[i] * t);
            return p;
        };
        const double s = g.between(-1, 1), h = std::pow(10.0, g.between(-3, 0));
        const double middle = P(s), sides = std::sqrt(P(s - h) * P(s + h));
        REQUIRE(middle >= sides * (1 - 1e-14));
        close += middle < 1 && middle > 0 && middle < sides * (1 + 1e-4);
    }
    CHECK(close > 1'000);
}

TEST_CASE("what is recognized as a product, or as one minus a product, has the density's values") {
    int recognized = 0, complements = 0, shared = 0;
    for (auto seed : seeds(6'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const Density a = product(g, 1 + g.below(2)), b = product(g, 1 + g.below(2));
        const auto d = [&]() -> Density {
            switch (g.below(8)) {
                case 0: return a * b;
                case 1: return a & b;
                case 2: return a | b;
                case 3: return ~(a & b);
                case 4: return a & ~b;
                case 5: return a - a * b;  // has the plane of a twice
                case 6: return g.legal(1);
                default: return g.boolean(2);
            }
        }();
        const DensityTree tree = flatten(d, g.chance(0.1) ? 0.0 : g.between(0.05, 0.6));
        // The tree is pruned to a small box, as in a cell.
        const Vec3 lo = g.near(tree);
        const DensityTree local = prune(tree, {lo, lo + Vec3(0.1)}).tree;
        const LocalDensity density(local);
        const auto convex = convex_density(density, scale);
        if (!convex) continue;
        ++recognized;
        complements += convex->complement;
        shared += convex->planes.size() < density.half_spaces().size();
        for (int k = 0; k < 10; ++k) {
            const Vec3 x = k < 5 ? lo + 0.1 * Vec3(g.number(), g.number(), g.number()) : g.near(local);
            if (on_a_jump(local, x)) continue;
            REQUIRE(value(*convex, x) == Approx(plain::density(local, x)).margin(1e-13));
        }
    }
    CHECK(recognized > 3'000);
    CHECK(complements > 300);
    CHECK(shared > 100);
}

TEST_CASE("a product's crossings are those of the search, whatever the ray") {
    int total = 0, grazing = 0, inside = 0, alone = 0;
    for (auto seed : seeds(20'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const int factors = g.chance(0.1) ? 4 + g.below(30) : 1 + g.below(3);
        const Density d = g.chance(0.7)         ? product(g, factors)
                          : 1 + g.below(2) == 1 ? ~product(g, factors)
                                                : product(g, 1) - product(g, 1) * product(g, 1);
        const DensityTree tree = flatten(d, g.between(0.05, 0.6));
        const LocalDensity density(tree);
        const auto convex = convex_density(density, scale);
        if (!convex) continue;
        const Vec3 aim = g.near(tree), o = g.chance(0.3) ? g.near(tree) : g.point(2);
        Vec3 direction = glm::normalize(aim - o);
        if (g.chance(0.3)) {  // nearly along one of the planes
            const Vec3 n = tree.half_spaces[g.below(int(tree.half_spaces.size()))].normal;
            const Vec3 flat = direction - n * glm::dot(direction, n);
            if (glm::length(flat) > 1e-3) direction = glm::normalize(flat + n * std::pow(10.0, g.between(-9, -1)));
        }
        const double t0 = g.chance(0.5) ? 0 : g.between(0, 1), t1 = t0 + g.between(0, 6);
        RayDensity ray;
        ray.set(density, o, direction);
        RootCounters counters;
        std::vector<RootCrossing> want;
        RootFinder({Criterion::exact, t_tolerance}, counters).crossings(ray, t0, t1, [&](RootCrossing c) {
            want.push_back(c);
            return true;
        });
        std::uint64_t evaluations = 0;
        const ConvexView view = ConvexView::of(*convex);
        const ConvexCrossings all = all_crossings(view, o, direction, t0, t1, t_tolerance, evaluations);
        const ConvexCrossing first = first_crossing(view, o, direction, t0, t1, t_tolerance, evaluations);
        const bool any = any_crossing(view, o, direction, t0, t1, t_tolerance, evaluations);
        REQUIRE(any == (first.t < infinity));
        REQUIRE(any == (all.count > 0));
        if (any) {
            REQUIRE(all.at[0].t == Approx(first.t).margin(1e-12));
            REQUIRE(all.at[0].entering == first.entering);
        }
        const double rho = plain::density(tree, o + direction * t0);
        if (std::abs(rho - 0.5) > 1e-9) {
            REQUIRE(all.start_inside == (rho > 0.5));
            inside += rho > 0.5;
        }
        // The reference search may overlook a dip of 10⁻⁹ (is_near_zero), and so may a ray that starts on the surface.
        const auto near_zero = [&](double t) {
            return std::abs(ray.at(t).slope) < 1e-5 || std::abs(t - t0) < 1e-9 || std::abs(t - t1) < 1e-9;
        };
        if (int(want.size()) != all.count) {
            bool explained = false;
            for (const RootCrossing& c : want) explained |= near_zero(c.t);
            for (int i = 0; i < all.count; ++i) explained |= near_zero(all.at[i].t);
            ++grazing;
            REQUIRE(explained);
            continue;
        }
        for (std::size_t i = 0; i < want.size(); ++i) {
            REQUIRE(all.at[i].entering == want[i].entering);
            const double slope = std::abs(ray.at(want[i].t).slope);
            REQUIRE(std::abs(all.at[i].t - want[i].t) <= 1e-12 + 1e-13 / slope);
            const Vec3 n = surface_normal(view, all.at[i], o + direction * all.at[i].t),
                       gradient = ray.gradient(want[i].t);
            if (slope > 1e-3) REQUIRE(glm::length(glm::cross(n, gradient)) < 1e-6 * glm::length(gradient));
            alone += all.at[i].plane >= 0;
        }
        total += int(want.size());
    }
    CHECK(total > 5'000);
    CHECK(inside > 1'000);
    CHECK(alone > 1'000);
    CHECK(grazing < 100);
}

TEST_CASE("sharp factors clip a product: its crossings against the plain definition") {
    int total = 0, at_sharp = 0;
    for (auto seed : seeds(10'000)) {
        CAPTURE(seed);
        Gen g(seed);
        Density d = product(g, 1 + g.below(2));
        for (int i = g.below(3); i >= 0; --i) d = d * Density::half_space(g.normal(), g.between(-0.2, 0.4)).radius(0);
        if (g.chance(0.3)) d = ~d;
        const Solid solid = Solid::rounded(g.between(0.05, 0.4), d);
        const SolidTree tree = flatten(solid);
        const LocalDensity density(tree.leaves[0].density);
        const auto convex = convex_density(density, scale);
        if (!convex || !density.has_sharp()) continue;
        REQUIRE(convex->sharp > 0);
        // The noise of 0.05 keeps the ray off the sharp edges, where either answer is right.
        const Vec3 o = g.point(3), direction = glm::normalize(g.near(tree.leaves[0].density) + g.point(0.05) - o);
        std::uint64_t evaluations = 0;
        const ConvexView view = ConvexView::of(*convex);
        const ConvexCrossings all = all_crossings(view, o, direction, 0, 12, t_tolerance, evaluations);
        const double want = plain::first_crossing(tree, o, direction, 12, 16);
        const double got = all.count > 0 ? all.at[0].t : infinity;
        const bool slip = got < want && plain::contains(tree, o + direction * (got - 1e-7)) !=
                                            plain::contains(tree, o + direction * (got + 1e-7));
        if (!slip) REQUIRE((got == want || std::abs(got - want) < 1e-7));
        REQUIRE(any_crossing(view, o, direction, 0, 12, t_tolerance, evaluations) == (all.count > 0));
        for (int i = 0; i < all.count; ++i) {
            ++total;
            at_sharp += all.at[i].plane >= int(convex->planes.size()) - convex->sharp;
            if (i > 0) REQUIRE(all.at[1].entering != all.at[0].entering);
        }
    }
    CHECK(total > 4'000);
    CHECK(at_sharp > 1'000);
}
