// Roots of a density along a ray: the bounds M, L and G, the criterion for at most one root, and the search.
#include "bounds/root_finder.hpp"

#include "catch.hpp"
#include "plain_definition.hpp"
#include "random_case.hpp"

using namespace deburr;

TEST_CASE("M, L and G bound a density, its slope and its slope's slope on a segment") {
    int exercised = 0, close = 0;
    for (auto seed : seeds(8'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const Density d = g.chance(0.4) ? g.boolean(2) : g.chance(0.5) ? g.legal(2) : g.arithmetic(2);
        const DensityTree tree = flatten(d, g.between(0.05, 0.6));
        const LocalDensity local(tree);
        if (local.has_sharp()) continue;
        RayDensity ray;
        ray.set(local, g.near(tree), g.direction());
        const double t0 = 0, length = std::pow(10.0, g.between(-3, 0));
        const auto [M, L, G] = ray.bounds(t0, t0 + length);
        const double h = 1e-5 * length;
        for (int k = 0; k < 12; ++k) {
            const double t = t0 + h + (length - 2 * h) * (k / 11.0);
            const auto [value, slope] = ray.at(t);
            REQUIRE(std::abs(value) <= M * (1 + 1e-12) + 1e-12);
            REQUIRE(std::abs(slope) <= L * (1 + 1e-12) + 1e-12);
            const double curve = (ray.at(t + h).slope - ray.at(t - h).slope) / (2 * h);
            REQUIRE(std::abs(curve) <= G * (1 + 1e-4) + 1e-9 / h);
            exercised += std::abs(slope) > 1e-3;
            close += std::abs(slope) > 0.99 * L && L > 0;
        }
    }
    CHECK(exercised > 20'000);
    CHECK(close > 2'000);
}

TEST_CASE("Lobb's eq. 6 accepts a segment with two roots; the exact criterion does not") {
    // Let f = 0⁺ with slope 1 into the segment at both ends, and L = G = 1. The quickest f brakes, turns, crosses 0 and
    // brakes again: it rests at 0 after (1 + √2). Two such halves, back to back, are 4.83 long and touch 0 in the
    // middle; in a slightly longer segment they cross 0.
    const RayBounds bounds{1, 1, 1};
    const SegmentEnd end{1e-12, 1};
    CHECK(min_turning_distance(end, bounds) == Approx(1 + std::sqrt(2.0)));
    CHECK(lobb_turning_distance(end, bounds) == Approx(3));

    // The function has f″ = −1, +1, +1, −1 in turn and is mirrored about its middle. With half a length of 2.75, f in
    // the middle is below 0.
    const double half = 2.75, w = (half - 1) / 2;  // 1 + w to reach slope −w, then w to reach slope 0
    const double lowest = 1e-12 + 0.5 - w * w;
    REQUIRE(w <= 1);
    REQUIRE(lowest < 0);  // then each half holds a root
    CHECK(at_most_one_root(end, end, bounds, 2 * half, Criterion::lobb));
    CHECK_FALSE(at_most_one_root(end, end, bounds, 2 * half, Criterion::exact));
}

TEST_CASE("no function within the bounds reaches a turning point beyond a root sooner") {
    int reached = 0, close = 0;
    for (auto seed : seeds(60'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const double L = std::pow(10.0, g.between(-1, 1)), G = std::pow(10.0, g.between(-1, 1));
        const double f0 = g.chance(0.2) ? 0.0 : g.between(-1, 1) * L * L / G, v0 = g.between(-1, 1) * L;
        const double least = min_turning_distance({f0, v0}, {1, L, G});
        // Accelerates fully towards the root and brakes near the best moment. This family contains the optimum.
        const double sign = f0 > 0 || (f0 == 0 && v0 < 0) ? 1.0 : -1.0;
        double f = f0 * sign, v = v0 * sign, t = 0;
        const auto advance = [&](double a, double time) {
            // Once |v| = L, f moves on at that speed.
            while (time > 0) {
                double step = time;
                if (a < 0 && v + a * step < -L) step = std::max(0.0, (-L - v) / a);
                if (a > 0 && v + a * step > L) step = std::max(0.0, (L - v) / a);
                if (step <= 0) {
                    f += v * time;
                    t += time;
                    return;
                }
                f += v * step + 0.5 * a * step * step;
                v += a * step;
                t += step;
                time -= step;
            }
        };
        const double peak = std::min(L, std::sqrt(std::max(0.0, G * std::abs(f) + 0.5 * v * v)));
        const double away = std::max(0.0, (v + peak) / G);
        const double coast = peak == L ? std::max(0.0, (std::abs(f) + v * v / (2 * G) - L * L / G) / L) : 0.0;
        advance(-G, away * (g.chance(0.5) ? 1 + 1e-9 : g.between(0.5, 1.5)));
        advance(0, coast * (g.chance(0.5) ? 1 + 1e-9 : g.between(0.5, 1.5)));
        if (v < 0) advance(G, -v / G);  // until v = 0, a turning point
        if (f <= 1e-12 && std::abs(v) < 1e-9) {
            ++reached;
            REQUIRE(t >= least * (1 - 1e-6));
            close += t < least * (1 + 1e-3);
        }
    }
    CHECK(reached > 20'000);
    CHECK(close > 5'000);
}

TEST_CASE("all crossings of a segment are found, in order", "[slow]") {
    int many = 0, total = 0;
    for (auto seed : seeds(3'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const Density d = g.chance(0.5) ? g.boolean(3) : g.arithmetic(2);
        const DensityTree tree = flatten(d, g.between(0.03, 0.4));
        const LocalDensity local(tree);
        if (local.has_sharp()) continue;
        const Vec3 o = g.point(2), to = glm::normalize(g.near(tree) - o);
        RayDensity ray;
        ray.set(local, o, to);
        RootCounters counters;
        std::vector<RootCrossing> found;
        RootFinder({}, counters).crossings(ray, 0, 6, [&](RootCrossing c) {
            found.push_back(c);
            return true;
        });
        // The reference samples the side at 3,000 points; two roots between neighbouring samples may go unseen.
        bool inside = plain::density(tree, o) > 0.5;
        std::size_t next = 0;
        for (int k = 1; k <= 3'000; ++k) {
            const double t = 6.0 * k / 3'000;
            while (next < found.size() && found[next].t <= t) {
                REQUIRE(found[next].entering != inside);
                REQUIRE(std::abs(plain::density(tree, o + to * found[next].t) - 0.5) < 1e-9);
                inside = found[next++].entering;
            }
            const double rho = plain::density(tree, o + to * t);
            if (std::abs(rho - 0.5) > 1e-9 && (rho > 0.5) != inside) FAIL("at t = " << t << " the density is " << rho);
        }
        total += int(found.size());
        many += found.size() > 2;
    }
    CHECK(total > 1'000);
    CHECK(many > 40);
}

TEST_CASE("the exact criterion accepts segments that eq. 6 sends on to be split, and is right") {
    RootCounters exact, lobb;
    for (auto seed : seeds(1'500)) {
        Gen g(seed);
        const LocalDensity local(flatten(g.boolean(2), g.between(0.05, 0.5)));
        if (local.has_sharp()) continue;
        const Vec3 o = g.point(2), to = glm::normalize(g.point(0.5) - o);
        RayDensity ray;
        ray.set(local, o, to);
        const auto pass = [](RootCrossing) { return true; };
        RootFinder({Criterion::exact}, exact).crossings(ray, 0, 6, pass);
        RootFinder({Criterion::lobb}, lobb).crossings(ray, 0, 6, pass);
    }
    CAPTURE(exact.segments, lobb.segments);
    CHECK(exact.segments < lobb.segments);
}

TEST_CASE("a ray in the plane of a flush face is done soon, though f is 0 along it but for rounding") {
    // Lobb's sum of touching boxes and a Boolean union of overlapping boxes: in the plane of the top ρ = ½, however the
    // half-spaces beside it vary.
    const auto box = [](Vec3 lo, Vec3 hi) { return Density::box(lo, hi); };
    const Density sum = box({0, 0, 0}, {1, 1, 1}) + box({1, 0, 0}, {2, 1, 1});
    const Density boolean = box({0, 0, 0}, {2, 1, 1}) | box({1, 0, 0}, {3, 1, 1}) | box({0.5, 0.2, -1}, {2.5, 1, 2});
    for (const Density& d : {sum, boolean})
        for (const double r : {1e-3, 0.1, 0.4})
            for (const double height : {1.0, 1 + 1e-16, 1 - 1e-12, 1 + 1e-9}) {
                CAPTURE(r, height);
                const LocalDensity local(flatten(d, r));
                RayDensity ray;
                ray.set(local, {5, height, 0.5}, {-1, 0, 0});
                RootCounters counters;
                int crossings = 0;
                RootFinder({}, counters).crossings(ray, 0, 8, [&](RootCrossing) { return ++crossings; });
                CHECK(counters.evaluations < 1'000'000);
                if (height >= 1) CHECK(crossings == 0);
            }
}
