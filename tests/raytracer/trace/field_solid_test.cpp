// Rays against CSG of fields and rounded polyhedra, held against the plain definition.
#include "ball_field.hpp"
#include "catch.hpp"
#include "plain_definition.hpp"
#include "random_case.hpp"
#include "raytracer/trace/implicit_tracer.hpp"

using namespace deburr;

TEST_CASE("placed fields and rounded polyhedra, combined, are hit where the definition says", "[slow]") {
    int rays = 0, hits = 0, differ = 0;
    for (auto seed : seeds(400)) {
        Gen g(seed);
        const auto ball = [&] { return Solid::of_field(std::make_shared<BallField>()).transformed(g.map()); };
        const Solid other = g.chance(0.5) ? g.solid(1) : ball();
        const int op = g.below(4);
        const Solid solid = op == 0   ? ball() | other
                            : op == 1 ? ball() & other
                            : op == 2 ? ball() - other
                                      : other - ball();
        const SolidTree tree = flatten(solid);
        const ImplicitTracer tracer({solid});
        for (int k = 0; k < 20; ++k) {
            const Vec3 o = g.chance(0.2) ? g.point(1) : g.point(4), d = glm::normalize(g.point(1) - o);
            TraceCounters counters;
            const Hit hit = tracer.closest_hit({o, d}, 100, counters);
            const auto side = [&](double t) { return plain::contains(tree, o + d * t); };
            double want = plain::first_crossing(tree, o, d, 100, 100);
            // The definition's samples may step over a sliver; a nearer hit is right if the definition changes sides
            // there.
            if (hit.t < want && side(hit.t - 1e-7) != side(hit.t + 1e-7)) want = hit.t;
            ++rays;
            hits += want < infinity;
            differ += hit.t != want && !(std::abs(hit.t - want) < 1e-5);
            if (hit.t == infinity) continue;
            REQUIRE(glm::length(hit.normal) == Approx(1));
            // The normal points out of the solid, so against the ray where the ray enters.
            const bool enters = plain::contains(tree, o + d * (hit.t + 1e-6));
            if (std::abs(glm::dot(hit.normal, d)) > 1e-3) CHECK((glm::dot(hit.normal, d) < 0) == enters);
        }
    }
    CHECK(hits > 1'500);
    CHECK(differ <= rays / 2'000);  // grazing rays
}
