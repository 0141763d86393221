// Rays against quadrics and free forms, held against the plain definition.
#include <cstdio>

#include "catch.hpp"
#include "plain_definition.hpp"
#include "random_free_form.hpp"
#include "raytracer/trace/agreement.hpp"
#include "raytracer/trace/implicit_tracer.hpp"

using namespace deburr;

namespace {

void compare_rays(const Solid& solid, Gen& g, int rays, int steps, double reach, Agreement& a) {
    const SolidTree tree = flatten(solid);
    const ImplicitTracer tracer({solid});
    for (int k = 0; k < rays; ++k) {
        const Vec3 o = g.chance(0.15) ? g.point(0.6) : g.point(4), d = glm::normalize(g.point(reach) - o);
        TraceCounters counters;
        const Hit hit = tracer.closest_hit({o, d}, 100, counters);
        const double want = expected_hit(tree, o, d, hit.t, 100, steps);
        ++a.rays;
        a.hits += want < infinity;
        if (!agree(hit.t, want)) {
            UNSCOPED_INFO("from " << o.x << ' ' << o.y << ' ' << o.z << ": " << hit.t << ", not " << want);
            ++a.differ;
        }
        if (!hit) continue;
        REQUIRE(glm::length(hit.normal) == Approx(1));
        const bool enters = plain::contains(tree, o + d * (hit.t + 1e-6));
        if (std::abs(glm::dot(hit.normal, d)) > 1e-2) CHECK((glm::dot(hit.normal, d) < 0) == enters);
    }
}

Solid solid_of(const Quadric& q) { return Solid::of_field(std::make_shared<FreeForm>(q, std::vector<Perturbation>{})); }

}  // namespace

TEST_CASE("free forms of up to 80 perturbations are hit where the definition says", "[slow]") {
    Agreement a;
    for (auto seed : seeds(150)) {
        CAPTURE(seed);
        Gen g(seed);
        const int count = seed % 5 == 0 ? 80 : g.below(25);
        compare_rays(Solid::of_field(random_free_form(g, count)), g, 40, 400, 1, a);
    }
    CHECK(a.hits > 2'500);
    CHECK(a.differ == 0);
}

TEST_CASE("free forms, mirrored, sheared and scaled unevenly, under CSG with rounded polyhedra", "[slow]") {
    Agreement a;
    for (auto seed : seeds(250)) {
        CAPTURE(seed);
        Gen g(seed);
        const auto form = [&] {
            const Solid s = Solid::of_field(random_free_form(g, g.below(8)));
            return g.chance(0.5) ? s.transformed(g.map()) : s;
        };
        const Solid first = form(), other = g.chance(0.7) ? g.solid(1) : form();
        const int op = g.below(4);
        compare_rays(op == 0   ? first | other
                     : op == 1 ? first & other
                     : op == 2 ? first - other
                               : other - first,
                     g, 25, 200, 1, a);
    }
    CHECK(a.hits > 2'000);
    CHECK(a.differ <= a.rays / 2'000);  // grazing rays
}

TEST_CASE("quadrics of every kind, infinite ones too, near and far away") {
    Agreement a;
    for (auto seed : seeds(400)) {
        CAPTURE(seed);
        Gen g(seed);
        compare_rays(solid_of(random_quadric(g)), g, 20, 2'000, 3, a);
    }
    CHECK(a.hits > 3'000);
    CHECK(a.differ <= a.rays / 2'000);
}

TEST_CASE("a paraboloid is there all the way to infinity") {
    // In y = x² + z² a horizontal ray from the axis at height h meets the surface after √h.
    const ImplicitTracer tracer({solid_of(revolved({0, 1, 0, -1}, Vec3(0), {0, 1, 0}, 1, 1))});
    for (const double h : {1e-6, 1.0, 1e3, 1e6, 1e10}) {
        TraceCounters counters;
        for (const Vec3 d : {Vec3(1, 0, 0), Vec3(0.6, 0, -0.8)}) {
            CHECK(tracer.closest_hit({{0, h, 0}, d}, infinity, counters).t == Approx(std::sqrt(h)).epsilon(1e-9));
            CHECK(tracer.closest_hit({-1e3 * d * std::sqrt(h) + Vec3(0, h, 0), d}, infinity, counters).t ==
                  Approx(999 * std::sqrt(h)).epsilon(1e-9));
        }
        CHECK_FALSE(tracer.closest_hit({{0, h, 0}, {0, 1, 0}}, infinity, counters));
        CHECK(tracer.closest_hit({{0, -h, 0}, {0, 1, 0}}, infinity, counters).t == Approx(h));
        CHECK_FALSE(tracer.closest_hit({{0, -h, 0}, {1, 0, 0}}, infinity, counters));
    }
}

TEST_CASE("rays along the lines of cylinders, cones and hyperboloids do not stop the search") {
    // Rounding decides whether a ray in the surface is inside; the test is that the query returns.
    for (auto seed : seeds(300)) {
        CAPTURE(seed);
        Gen g(seed);
        const Affine map = g.map(false);
        const Revolution forms[3] = {{1, 0, 0, -1}, {0, 0, 1, -1}, {1, 0, 1, -1}};
        const int kind = g.below(3);
        const double a = g.between(0, 7);
        const Vec3 ring(std::cos(a), 0, std::sin(a)), tangent(-std::sin(a), 0, std::cos(a)), up(0, 1, 0);
        const Vec3 line = kind == 0 ? up : kind == 1 ? ring + up : tangent + up;
        const Solid solid = solid_of(revolved(forms[kind], Vec3(0), up, 1, 1)).transformed(map);
        const ImplicitTracer tracer({solid, solid_of(random_ellipsoid(g, 0.1, 0.2, 0.1))});
        TraceCounters counters;
        const Vec3 o = map((kind == 1 ? Vec3(0) : ring) - 3.0 * line), d = glm::normalize(map.linear * line);
        tracer.closest_hit({o, d}, infinity, counters);
        tracer.closest_hit({o, d}, 10, counters);
        REQUIRE(counters.segments < 5'000);
    }
}

TEST_CASE("grazing rays: a ball is hit or missed right to a millionth of what is to be seen") {
    for (const double radius : {1e-3, 1.0, 1e3})
        for (const double gap : {1e-6, 1e-9, 1e-11}) {
            CAPTURE(radius, gap);
            Quadric q;
            q.A = Mat3(-1 / (radius * radius));
            q.k = 1;
            const ImplicitTracer tracer({solid_of(q)});
            TraceCounters counters;
            for (const double side : {-1.0, 1.0}) {
                const double y = side * radius;
                const Hit hit = tracer.closest_hit({{-5 * radius, y * (1 - gap), 0}, {1, 0, 0}}, infinity, counters);
                REQUIRE(hit);
                CHECK(hit.t == Approx(radius * (5 - std::sqrt(2 * gap))).epsilon(1e-3 * std::sqrt(gap)));
                CHECK_FALSE(tracer.closest_hit({{-5 * radius, y * (1 + gap), 0}, {1, 0, 0}}, infinity, counters));
            }
        }
}

TEST_CASE("thin sheets are seen from wherever they are looked at") {
    for (const double thickness : {1e-2, 1e-4, 1e-6}) {
        CAPTURE(thickness);
        Quadric disc;  // of radius 1 and this thickness in the middle
        disc.A = Mat3(Vec3(-1, 0, 0), Vec3(0, -4 / (thickness * thickness), 0), Vec3(0, 0, -1));
        disc.k = 1;
        const Solid solids[2] = {
            solid_of(disc),
            // A shell between two balls.
            solid_of(revolved({1, 0, -1, -1}, Vec3(0), {0, 1, 0}, 1, 1)) -
                solid_of(revolved({1, 0, -1, -1}, Vec3(0), {0, 1, 0}, 1 - thickness, 1 - thickness))};
        for (const Solid& solid : solids) {
            const ImplicitTracer tracer({solid});
            for (auto seed : seeds(300)) {
                CAPTURE(seed);
                Gen g(seed);
                const Vec3 aim(g.between(-0.6, 0.6), 0, g.between(-0.6, 0.6));
                const Vec3 o = 5.0 * g.direction() + Vec3(0, 1e-3, 0), d = glm::normalize(aim - o);
                TraceCounters counters;
                const Hit hit = tracer.closest_hit({o, d}, infinity, counters);
                REQUIRE(hit);
                REQUIRE(std::abs(glm::length(hit.normal) - 1) < 1e-9);
                // The ray passes through the sheet to its other side, and on.
                const Hit next = tracer.closest_hit({o + d * (hit.t + 1e-9), d}, infinity, counters);
                REQUIRE(next);
                REQUIRE(next.t <= thickness / std::max(1e-3, std::abs(d.y)) * 3 + 0.1);
            }
        }
    }
}

TEST_CASE("rays that leave a surface do not meet it at once, also where large terms cancel in it") {
    int hits = 0, again = 0;
    for (auto seed : seeds(60)) {
        Gen g(seed);
        // A bump that contains a dent, each a thousand times as high as their sum.
        const Quadric disc = random_ellipsoid(g, 0.6, 0.8, 0.3);
        Quadric hole = disc;
        hole.A = hole.A * g.between(1.2, 1.6);
        const double f = g.between(30, 3'000);
        const ImplicitTracer tracer({Solid::of_field(std::make_shared<FreeForm>(
            random_ellipsoid(g, 0.5, 1, 0.1), std::vector<Perturbation>{{f, disc}, {-2 * f, hole}}))});
        for (int k = 0; k < 400; ++k) {
            TraceCounters counters;
            const Vec3 o = 4.0 * g.direction();
            const Hit hit = tracer.closest_hit({o, glm::normalize(g.point(0.5) - o)}, infinity, counters);
            if (!hit) continue;
            ++hits;
            const Vec3 d = g.direction();
            if (std::abs(glm::dot(d, hit.normal)) < 0.2) continue;
            again += tracer.closest_hit(leave(hit, d), infinity, counters).t < 1e-6;
            CHECK(hit.offset < 1e-7);  // far below anything visible
        }
    }
    CHECK(hits > 10'000);
    CHECK(again == 0);
}

TEST_CASE("a form of many perturbations costs what reaches the cell") {
    // A bar with bumps of one density; ten and a hundred times as long.
    double cost[3];
    int i = 0;
    for (const int count : {10, 100, 1000}) {
        Gen g(7);
        std::vector<Perturbation> bumps;
        for (int k = 0; k < count; ++k) {
            Quadric q = random_ellipsoid(g, 0.3, 0.7, 0.5);
            q.center.x += 0.5 * k;
            bumps.push_back({g.between(-1, 1), q});
        }
        Quadric bar;
        bar.A[1][1] = bar.A[2][2] = -4;
        bar.k = 1;
        const auto form = std::make_shared<FreeForm>(bar, bumps);
        const ImplicitTracer tracer({Solid::of_field(form)});
        TraceCounters counters;
        for (int k = 0; k < 2'000; ++k) {
            const Vec3 to(g.between(0, 0.5 * count), g.between(-0.4, 0.4), g.between(-0.4, 0.4));
            tracer.closest_hit(
                {to + 3.0 * glm::normalize(g.direction() + Vec3(0, 2, 0)), glm::normalize(Vec3(0.1, -1, 0.1))}, 100,
                counters);
        }
        cost[i++] = tracer.statistics().mean_local_half_spaces * double(counters.evaluations) / 2'000;
    }
    CAPTURE(cost[0], cost[1], cost[2]);
    CHECK(cost[1] < 1.3 * cost[0]);
    CHECK(cost[2] < 1.3 * cost[0]);
}
