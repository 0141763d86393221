// Ray packets against sums of products, round parts and tori, bit by bit.
#include <functional>
#include <optional>

#include "catch.hpp"
#include "random_case.hpp"
#include "raytracer/simd/packet_kernels.hpp"
#include "raytracer/simd/random_packet.hpp"
#include "round_cell.hpp"

using namespace deburr;

namespace {

// Aims the packet's rays at points near a surface; some are nearly at right angles to a vector from across().
void aim(Gen& g, Packet& p, const std::function<Vec3()>& target, const std::function<Vec3()>& across) {
    for (int k = 0; k < RayPacket::size; ++k) {
        Vec3 direction = glm::normalize(target() - p.origin(k));
        const Vec3 n = across(), flat = direction - n * glm::dot(direction, n);
        if (g.chance(0.3) && glm::length(flat) > 1e-3)
            direction = glm::normalize(flat + n * std::pow(10.0, g.between(-17, -1)));
        for (int axis = 0; axis < 3; ++axis) p.rays.direction[axis][k] = direction[axis];
    }
}

struct SumTally {
    int crossed = 0, missed = 0, split = 0;
};

void check_sum(const PacketFunctions& functions, const ProductSum& sum, const Packet& p, SumTally& tally) {
    PacketCrossings found;
    PacketNearest nearest;
    alignas(64) double normal[3][RayPacket::size];
    RootCounters together, alone;
    const Lanes lanes = functions.sum_crossings(sum, p.rays, p.lanes, p.spans, packet_scale, found, together);
    CHECK((lanes & ~p.lanes) == 0);
    nearest.entering = found.entering;
    functions.sum_normals(sum, p.rays, found.t, lanes, nearest, normal);
    ProductSumRay ray;
    const auto first = [&](int k, bool coarse) {
        std::optional<RootCrossing> c;
        ray.set(sum, p.origin(k), p.direction(k));
        ray.crossings(p.spans.from[k], p.spans.to[k], t_tolerance(p.spans.from[k]), coarse, alone,
                      [&](RootCrossing at) {
                          c = at;
                          return false;
                      });
        return c;
    };
    for_each_lane(p.lanes, [&](int k) {
        const auto c = first(k, false);
        REQUIRE(bool(lanes >> k & 1) == c.has_value());
        ++(c ? tally.crossed : tally.missed);
        if (!c) return;
        REQUIRE(same_bits(found.t[k], c->t));
        REQUIRE(bool(found.entering >> k & 1) == c->entering);
        Vec3 n = ray.gradient(c->t);
        const double length = glm::length(n);
        n = length > 0 ? n / length : p.direction(k);
        if ((glm::dot(n, p.direction(k)) < 0) != c->entering) n = -n;
        for (int axis = 0; axis < 3; ++axis) REQUIRE(normal[axis][k] == n[axis]);
    });
    REQUIRE(together.evaluations == alone.evaluations);
    REQUIRE(together.segments == alone.segments);
    REQUIRE(together.splits == alone.splits);
    tally.split += alone.splits > 0;
    together = alone = {};
    const Lanes any = functions.sum_any_crossings(sum, p.rays, p.lanes, p.spans, packet_scale, together);
    for_each_lane(p.lanes, [&](int k) { REQUIRE(bool(any >> k & 1) == first(k, true).has_value()); });
    REQUIRE(together.evaluations == alone.evaluations);
}

void check_surface(const PacketFunctions& functions, const RoundSurface& surface, const Packet& p, int& crossed) {
    PacketCrossings found;
    PacketNearest nearest;
    alignas(64) double normal[3][RayPacket::size];
    const Lanes lanes = functions.surface_crossings(surface, p.rays, p.lanes, p.spans, found);
    nearest.entering = found.entering;
    functions.surface_normals(surface, p.rays, found.t, lanes, nearest, normal);
    for_each_lane(p.lanes, [&](int k) {
        const RoundCrossings all = surface.crossings(p.origin(k), p.direction(k), p.spans.from[k], p.spans.to[k]);
        REQUIRE(bool(lanes >> k & 1) == (all.count > 0));
        if (all.count == 0) return;
        ++crossed;
        REQUIRE(same_bits(found.t[k], all.at[0].t));
        REQUIRE(bool(found.entering >> k & 1) == all.at[0].entering);
        Vec3 n = surface.normal(p.origin(k) + p.direction(k) * all.at[0].t);
        if ((glm::dot(n, p.direction(k)) < 0) != all.at[0].entering) n = -n;
        for (int axis = 0; axis < 3; ++axis) REQUIRE(normal[axis][k] == n[axis]);
    });
}

}  // namespace

TEST_CASE("rays of a packet cross sums of products where they do alone, to the bit") {
    for (const auto& [name, functions] : packet_instructions()) {
        CAPTURE(name);
        SumTally tally;
        for (auto seed : seeds(8'000)) {
            CAPTURE(seed);
            Gen g(seed);
            const Density d = g.chance(0.4) ? g.boolean(2) : g.chance(0.6) ? g.legal(2) : g.arithmetic(2);
            const DensityTree whole = flatten(d, g.between(0.05, 0.6));
            const Vec3 lo = g.near(whole);
            const DensityTree tree = prune(whole, {lo, lo + Vec3(g.between(0.05, 0.6))}).tree;
            const LocalDensity density(tree);
            if (density.half_spaces().size() < 2) continue;
            const auto sum = ProductSum::of(density, 1e-12);
            if (!sum) continue;
            Packet p(g);
            aim(
                g, p, [&] { return g.near(tree); },
                [&] { return tree.half_spaces[std::size_t(g.below(int(tree.half_spaces.size())))].normal; });
            check_sum(*functions, *sum, p, tally);
        }
        CHECK(tally.crossed > 2'000);
        CHECK(tally.missed > 2'000);
        CHECK(tally.split > 300);
    }
}

TEST_CASE("rays of a packet cross round parts, and sums with these, where they do alone, to the bit", "[slow]") {
    for (const auto& [name, functions] : packet_instructions()) {
        CAPTURE(name);
        SumTally tally;
        int sums = 0, surfaces = 0;
        for (auto seed : seeds(4'000)) {
            CAPTURE(seed);
            Gen g(seed);
            const test::RoundCell c(g, 1 + g.below(3));
            if (!c.local) continue;
            Packet p(g);
            aim(
                g, p, [&] { return c.point(g); }, [&] { return g.chance(0.5) ? Vec3(0, 0, 1) : g.normal(); });
            if (const auto surface = RoundSurface::of(*c.local)) check_surface(*functions, *surface, p, surfaces);
            const auto sum = ProductSum::of(*c.local, 1e-12);
            if (!sum || sum->rounds().empty()) continue;
            ++sums;
            check_sum(*functions, *sum, p, tally);
        }
        CHECK(sums > 500);
        CHECK(surfaces > 300);
        CHECK(tally.crossed > 1'000);
        CHECK(tally.missed > 1'000);
        CHECK(tally.split > 100);
    }
}

TEST_CASE("rays of a packet cross tori where they do alone, to the bit") {
    for (const auto& [name, functions] : packet_instructions()) {
        CAPTURE(name);
        int crossed = 0;
        for (auto seed : seeds(4'000)) {
            CAPTURE(seed);
            Gen g(seed);
            const double R = std::pow(10, g.between(-2, 1)), tube = R * (g.chance(0.3) ? 1e-3 : g.between(0.02, 1));
            const RoundCoordinate circle = RoundCoordinate::distance_from_circle(g.point(1), g.direction(), R);
            const RoundSurface torus{circle, tube, g.chance(0.3)};
            Packet p(g);
            const Vec3 u = glm::normalize(glm::cross(circle.axis, g.direction()));
            const auto near = [&] {  // on the tube, inside it, or anywhere
                const Vec3 out = glm::normalize(u + g.point(2) - circle.axis);
                const Vec3 across = glm::normalize(out - circle.axis * glm::dot(circle.axis, out));
                return circle.center + R * across + tube * (g.chance(0.5) ? g.direction() : g.point(3));
            };
            aim(g, p, near, [&] { return g.chance(0.3) ? circle.axis : g.direction(); });
            check_surface(*functions, torus, p, crossed);
        }
        CHECK(crossed > 8'000);
    }
}
