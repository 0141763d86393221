// Rays against solids with round parts, held against their plain definition.
#include "catch.hpp"
#include "plain_round.hpp"
#include "raytracer/trace/implicit_tracer.hpp"

using namespace deburr;
using test::RoundCase;

namespace {

// First change of sides on [0, length], by even samples and bisection; infinity if there is none. Two changes between
// samples go unseen.
template <class Inside>
double first_change(Inside inside, double length, int steps) {
    const bool start = inside(0.0);
    double before = 0;
    for (int k = 1; k <= steps; ++k) {
        double now = length * k / steps;
        if (inside(now) != start) {
            while (now - before > 1e-12) {
                const double middle = 0.5 * (before + now);
                (inside(middle) != start ? now : before) = middle;
            }
            return now;
        }
        before = now;
    }
    return infinity;
}

}  // namespace

TEST_CASE("solids with round parts are hit where the definition says", "[slow]") {
    int hits = 0, differ = 0, rays = 0;
    for (auto seed : seeds(600)) {
        CAPTURE(seed);
        Gen g(seed);
        const RoundCase c = test::round_case(g, 1 + g.below(4));
        const ImplicitTracer tracer({Solid::rounded(c.radius, c.density)});
        for (int k = 0; k < 25; ++k) {
            const Vec3 o = g.chance(0.3) ? g.point(0.5) : g.point(3), d = glm::normalize(g.point(0.7) - o);
            TraceCounters counters;
            const Hit hit = tracer.closest_hit({o, d}, 10, counters);
            const auto inside = [&](double t) { return c.plain.density(o + t * d, c.radius) > 0.5; };
            double want = first_change(inside, 10, 1'500);
            if (hit.t < want && inside(hit.t - 1e-6) != inside(hit.t + 1e-6)) want = hit.t;
            ++rays;
            hits += want < infinity;
            differ += hit.t != want && !(std::abs(hit.t - want) < 1e-6);
            if (hit.t == infinity) continue;
            CHECK(glm::length(hit.normal) == Approx(1));
            CHECK(tracer.any_hit({o, d}, 10, counters));
        }
    }
    CHECK(hits > 4'000);
    CHECK(differ <= rays / 3'000);  // grazing rays
}

TEST_CASE("single round parts are hit where geometry says, from near and far") {
    struct One {
        Density density;
        Vec3 from, direction;
        double expected;
    };
    const double r = 0.1;
    const One all[] = {
        {Density::sphere(Vec3(0.0), 1), {3, 0, 0}, {-1, 0, 0}, 2},
        {Density::sphere(Vec3(0.0), 1), {3, 0.6, 0}, {-1, 0, 0}, 2.2},
        {Density::cylinder({0, -2, 0}, {0, 2, 0}, 0.5), {3, 0.3, 0}, {-1, 0, 0}, 2.5},
        {Density::cylinder({0, -2, 0}, {0, 2, 0}, 0.5), {0, 9, 0}, {0, -1, 0}, 7},            // along the axis
        {Density::cylinder({0, -2, 0}, {0, 2, 0}, 0.5), {0.5 - 2e-3, 0, 5}, {0, 0, -1}, -1},  // nearly tangent
        {Density::cone({0, 0, 0}, {0, 2, 0}, 1, 0), {5, 1, 0}, {-1, 0, 0}, 4.5},
        {Density::torus(Vec3(0.0), {0, 1, 0}, 1, 0.25), {1, 3, 0}, {0, -1, 0}, 2.75},
        {Density::torus(Vec3(0.0), {0, 1, 0}, 1, 0.25), {-5, 0, 0}, {1, 0, 0}, 3.75},
    };
    for (const One& one : all) {
        const ImplicitTracer tracer({Solid::rounded(r, one.density)}), sharp({Solid::sharp(one.density)});
        for (const double away : {0.0, 10.0, 1e4, 1e8}) {
            CAPTURE(away, one.expected);
            TraceCounters counters;
            const Vec3 from = one.from - away * one.direction;
            const double expected =
                one.expected >= 0 ? one.expected : 5 - std::sqrt(0.25 - (0.5 - 2e-3) * (0.5 - 2e-3));
            for (const ImplicitTracer* t : {&tracer, &sharp})
                CHECK(t->closest_hit({from, one.direction}, infinity, counters).t ==
                      Approx(away + expected).epsilon(1e-14 + 1e-11 / (1 + away)));
        }
    }
}

TEST_CASE("thin rods, wide filters and shells of a millionth") {
    TraceCounters counters;
    const auto hit = [&](const Density& d, double r, Vec3 o, Vec3 u) {
        return ImplicitTracer({Solid::rounded(r, d)}).closest_hit({o, u}, infinity, counters).t;
    };
    // A thin rod vanishes as a wall does.
    const auto rod = [](double R) { return Density::cylinder({0, -20, 0}, {0, 20, 0}, R); };
    CHECK(hit(rod(0.68), 2, {0, 0, 9}, {0, 0, -1}) == infinity);
    const double on_axis = hit(rod(0.71), 2, {0, 0, 9}, {0, 0, -1});
    CHECK(on_axis > 8.29);
    CHECK(on_axis < 9);
    CHECK(hit(rod(1.5), 1, {0, 0, 9}, {0, 0, -1}) == Approx(7.5));
    // A tube of thickness 10⁻⁶ between coaxial cylinders, with a smaller and with a larger filter.
    const auto tube = [](double thickness) {
        return Density::cylinder({0, -2, 0}, {0, 2, 0}, 1) & ~Density::cylinder({0, -3, 0}, {0, 3, 0}, 1 - thickness);
    };
    CHECK(hit(tube(1e-6), 1e-7, {0, 0, 9}, {0, 0, -1}) == Approx(8));
    CHECK(hit(tube(1e-6), 1e-5, {0, 0, 9}, {0, 0, -1}) == infinity);
    // Coincident concentric and coaxial surfaces leave nothing, and no seam.
    const Density ball = Density::sphere(Vec3(0.0), 1);
    CHECK(hit(ball & ~ball, 0.1, {0, 0, 9}, {0, 0, -1}) == infinity);
    CHECK(hit(ball | ball, 0.1, {0, 0, 9}, {0, 0, -1}) == Approx(8));
    CHECK(hit(rod(1) | Density::cylinder({0, -5, 0}, {0, 1, 0}, 1), 0.1, {0, 1, 9}, {0, 0, -1}) == Approx(8));
}
