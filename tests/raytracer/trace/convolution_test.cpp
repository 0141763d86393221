// Rays against convolved solids, held against the set itself.
#include "bounds/solid_tree.hpp"
#include "catch.hpp"
#include "random_case.hpp"
#include "raytracer/trace/implicit_tracer.hpp"

using namespace deburr;

TEST_CASE("convolved solids are hit where the set begins or ends") {
    int hits = 0, curved = 0;
    for (auto seed : seeds(150)) {
        CAPTURE(seed);
        Gen g(seed);
        Density d = g.box();
        for (int k = g.below(3); k > 0; --k) d = g.chance(0.5) ? d | g.box() : d & ~g.box();
        if (d.has_radius()) continue;
        Solid solid = Solid::convolved(g.between(0.05, 0.4), d);
        if (g.chance(0.3)) solid = solid.transformed(g.map());
        if (g.chance(0.3)) solid = solid - Solid::rounded(0.1, g.box());
        const SolidTree tree = flatten(solid);
        const ImplicitTracer tracer({solid});
        for (int k = 0; k < 10; ++k) {
            const Vec3 target = 0.4 * g.point(1), origin = target + 3.0 * g.direction();
            const Ray ray{origin, glm::normalize(target - origin)};
            const auto inside = [&](double t) { return tree.contains(ray.origin + t * ray.direction); };
            TraceCounters counters;
            const double t = tracer.closest_hit(ray, 6, counters).t;
            const bool start = inside(0);
            if (t < infinity) {
                ++hits;
                curved += counters.evaluations > 0;
                CHECK(inside(t - 1e-7) != inside(t + 1e-7));
            }
            constexpr int steps = 300;
            for (int s = 0; s < steps; ++s) {
                const double at = std::min(t - 1e-7, 6.0) * (s + 0.5) / steps;
                REQUIRE(inside(at) == start);
            }
        }
    }
    CHECK(hits > 150);
    CHECK(curved > 100);
}
