// Rays against tori, rounded, sharp and as grooves in a block. They are found as roots of a quartic; the reference is
// the distance from the torus.
#include "catch.hpp"
#include "random_case.hpp"
#include "raytracer/trace/implicit_tracer.hpp"

using namespace deburr;

namespace {

struct Ring {
    Vec3 center, axis, u, v;
    double radius, tube;

    double distance(Vec3 x) const {
        const Vec3 y = x - center;
        return std::hypot(glm::length(glm::cross(axis, y)) - radius, glm::dot(axis, y)) - tube;
    }
    // First t where the distance is 0, by steps that cannot pass it; NaN if the ray only comes near the surface.
    double first(Vec3 o, Vec3 d, double end) const {
        const double side = distance(o) > 0 ? 1 : -1;
        constexpr double near = 1e-11;
        constexpr int steps = 100'000;
        double t = 0;
        for (int i = 0; i < steps && t < end; ++i) {
            const double away = side * distance(o + t * d);
            if (away < near) return side * distance(o + (t + 1e-5) * d) < 0 ? t : std::nan("");
            t += away;
        }
        return t < end ? std::nan("") : infinity;
    }
};

Ring random_ring(Gen& g) {
    Ring ring{g.point(0.5), g.direction(), {}, {}, g.between(0.5, 1.2), 0};
    ring.tube = ring.radius * (g.chance(0.3) ? g.between(0.02, 0.1) : g.between(0.1, 0.9));
    ring.u = glm::normalize(glm::cross(ring.axis, g.direction()));
    ring.v = glm::cross(ring.axis, ring.u);
    return ring;
}

}  // namespace

TEST_CASE(
    "a ring or a groove is hit where its distance is 0: along the axis, in its plane, tangent, from within and afar",
    "[slow]") {
    int hits[6] = {}, misses[6] = {}, unclear = 0;
    int at_once[2] = {}, searched[2] = {}, off = 0;
    for (auto seed : seeds(4'000)) {
        Gen g(seed);
        const Ring ring = random_ring(g);
        // The radius is the greatest that is possible, or so small that it hardly shows.
        const double r = g.chance(0.3) ? ring.radius - ring.tube : std::pow(10, g.between(-4, -1)) * ring.tube;
        if (r > ring.tube) continue;  // the density is another shape then
        const Density torus = Density::torus(ring.center, ring.axis, ring.radius, ring.tube);
        const bool is_groove = g.chance(0.4), is_sharp = !is_groove && g.chance(0.3);
        const double size = 12;  // so that rays begin inside
        const Density block = Density::box(Vec3(-size), Vec3(size));
        const ImplicitTracer tracer({is_sharp    ? Solid::sharp(torus)
                                     : is_groove ? Solid::rounded(r, block & ~torus)
                                                 : Solid::rounded(r, torus)});
        const double angle = g.between(0, 6.28), s = g.between(0, 1.5) * (ring.radius + ring.tube);
        const Vec3 out = std::cos(angle) * ring.u + std::sin(angle) * ring.v, around = glm::cross(ring.axis, out);
        const int kind = g.below(6);
        Vec3 o, d;
        switch (kind) {
            case 0:  // parallel to the axis, or on it
                o = ring.center + (g.chance(0.2) ? 0 : s) * out + 4.0 * ring.axis;
                d = -ring.axis;
                break;
            case 1:  // in the circle's plane, through the center or beside it
                o = ring.center + 4.0 * out + (g.chance(0.3) ? 0 : s) * around;
                d = -out;
                break;
            case 2: {  // touches the top circle or the inner equator within 10⁻⁷
                const double beside = 1e-7 * (g.chance(0.5) ? 1 : -1);
                o = ring.center + ring.radius * out + (ring.tube + beside) * ring.axis;
                d = g.chance(0.5) ? out : around;
                if (g.chance(0.4)) {
                    o = ring.center + (ring.radius - ring.tube - beside) * out;
                    d = ring.axis;
                }
                o -= 4.0 * d;
                break;
            }
            case 3:  // from inside the tube
                o = ring.center + ring.radius * out + 0.9 * g.number() * ring.tube * g.direction();
                d = g.direction();
                break;
            case 4:  // from far away
                o = ring.center + std::pow(10, is_groove ? 0.8 : g.between(1, 4)) * g.direction();
                d = glm::normalize(ring.center + g.point(0.7) - o);
                break;
            default: o = g.point(3); d = glm::normalize(ring.center + g.point(1.2) - o);
        }
        CAPTURE(seed, kind);
        const double end = 3 * glm::distance(o, ring.center) + 5, want = ring.first(o, d, end);
        TraceCounters counters;
        const Hit hit = tracer.closest_hit({o, d}, end, counters);
        if (std::isnan(want)) {  // the ray touches the surface
            ++unclear;
            continue;
        }
        ++(want < infinity ? hits : misses)[kind];
        if (want == infinity) {
            CHECK(hit.t > (is_groove ? 4 : 1e300));
            continue;
        }
        ++(counters.segments == 0 ? at_once : searched)[is_groove];
        REQUIRE(hit.t < infinity);
        // The hit is on the surface within the rounding error of its coordinates.
        off += !(std::abs(ring.distance(o + hit.t * d)) < 1e-14 * (is_groove ? 30 : 3 + glm::distance(o, ring.center)));
        // A ray that runs along the surface may meet it anywhere in a long stretch.
        CHECK(hit.t == Approx(want).margin(2e-4));
        CHECK(glm::distance(hit.normal, glm::normalize(hit.normal)) < 1e-9);
    }
    for (int kind = 0; kind < 6; ++kind) CHECK(hits[kind] > 50);
    CHECK(misses[0] > 20);
    CHECK(misses[2] > 20);
    CHECK(unclear < 200);
    CHECK(searched[0] == 0);
    CHECK(at_once[1] > searched[1]);  // block and groove share a cell where that costs little
    CHECK(off == 0);
}
