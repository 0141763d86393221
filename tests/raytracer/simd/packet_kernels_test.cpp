// Kernels for ray packets against single rays, bit by bit.
#include "raytracer/simd/packet_kernels.hpp"

#include "catch.hpp"
#include "random_case.hpp"
#include "raytracer/accel/bvh.hpp"
#include "raytracer/simd/random_packet.hpp"

using namespace deburr;

namespace {

// Planes that cross near the origin; some pass through it, some are parallel to axis-parallel rays.
struct Factors {
    std::vector<AlphaPlane> planes;
    ConvexView view;

    explicit Factors(Gen& g) {
        const int soft = g.chance(0.8) ? 1 + g.below(3) : g.below(max_packet_factors + 1),
                  sharp = g.chance(0.7) ? 0 : g.below(3);
        for (int i = 0; i < soft + sharp; ++i) {
            const double radius = i < soft ? g.between(0.02, 0.6) : 1.0;
            const Vec3 n = g.normal();
            planes.push_back({n / radius, (g.chance(0.2) ? 0.0 : g.between(-0.6, 0.3)) / radius});
        }
        view = {planes.data(), soft, sharp, g.chance(0.5)};
    }
};

}  // namespace

TEST_CASE("rays of a packet cross products of half-spaces where they do alone, to the bit") {
    for (const auto& [name, functions] : packet_instructions()) {
        CAPTURE(name);
        int crossed = 0, missed = 0, occluded = 0;
        for (auto seed : seeds(3'000)) {
            CAPTURE(seed);
            Gen g(seed);
            const Factors factors(g);
            const Packet p(g);
            PacketCrossings found;
            std::uint64_t evaluations = 0, alone = 0;
            const Lanes lanes =
                functions->convex_crossings(factors.view, p.rays, p.lanes, p.spans, packet_scale, found, evaluations);
            CHECK((lanes & ~p.lanes) == 0);
            for (int k = 0; k < RayPacket::size; ++k) {
                if (!(p.lanes >> k & 1)) continue;
                const ConvexCrossing c = first_crossing(factors.view, p.origin(k), p.direction(k), p.spans.from[k],
                                                        p.spans.to[k], t_tolerance(p.spans.from[k]), alone);
                REQUIRE((lanes >> k & 1) == (c.t < infinity));
                if (!(c.t < infinity)) {
                    ++missed;
                    continue;
                }
                ++crossed;
                REQUIRE(same_bits(found.t[k], c.t));
                REQUIRE(int(found.plane[k]) == c.plane);
                REQUIRE(bool(found.entering >> k & 1) == c.entering);
            }
            REQUIRE(evaluations == alone);
            evaluations = alone = 0;
            const Lanes any =
                functions->convex_any_crossings(factors.view, p.rays, p.lanes, p.spans, packet_scale, evaluations);
            for (int k = 0; k < RayPacket::size; ++k) {
                if (!(p.lanes >> k & 1)) continue;
                REQUIRE(bool(any >> k & 1) == any_crossing(factors.view, p.origin(k), p.direction(k), p.spans.from[k],
                                                           p.spans.to[k], t_tolerance(p.spans.from[k]), alone));
                occluded += any >> k & 1;
            }
            REQUIRE(evaluations == alone);
        }
        CHECK(crossed > 5'000);
        CHECK(missed > 5'000);
        CHECK(occluded > 5'000);
    }
}

TEST_CASE("rays of a packet are laid out, mapped and given normals as they are alone, to the bit") {
    for (const auto& [name, functions] : packet_instructions()) {
        CAPTURE(name);
        int alone = 0, entering = 0;
        for (auto seed : seeds(1'000)) {
            CAPTURE(seed);
            Gen g(seed);
            Ray rays[RayPacket::size];
            double t_max[RayPacket::size];
            for (int k = 0; k < RayPacket::size; ++k) {
                rays[k] = {g.point(3), g.chance(0.1) ? Vec3(0, 1, 0) : g.normal()};
                t_max[k] = g.chance(0.2) ? infinity : g.between(0, 5);
            }
            RayPacket packet, mapped;
            RayTerms terms;
            functions->load(packet, rays, t_max);
            const Lanes far = functions->prepare(packet, packet_scale, 2, terms);
            Affine map;
            for (int axis = 0; axis < 3; ++axis) map.linear[axis] = g.point(2);
            map.shift = g.point(5);
            const bool only_moved = g.chance(0.3);
            if (only_moved) map.linear = Mat3(1.0);
            alignas(64) double rate[RayPacket::size];
            functions->map(map, only_moved, packet, packet.t_max, mapped, rate);
            const Factors factors(g);
            PacketNearest nearest;
            for (int k = 0; k < RayPacket::size; ++k) {
                const Vec3 o = rays[k].origin, d = rays[k].direction, inverse = reciprocal(d);
                REQUIRE((packet.ray(k).origin == o && packet.ray(k).direction == d && packet.begin[k] == 0));
                REQUIRE((packet.t_max[k] == t_max[k] && packet.end[k] == t_max[k] && terms.end[k] == t_max[k]));
                for (int axis = 0; axis < 3; ++axis) REQUIRE(same_bits(terms.inverse[axis][k], inverse[axis]));
                REQUIRE(terms.coordinate_bound[k] == packet_scale + largest(o));
                REQUIRE(bool(far >> k & 1) == (largest(o) > 2));
                const Vec3 along = only_moved ? d : map.linear * d;
                const double length = only_moved ? 1 : glm::length(along);
                REQUIRE(same_bits(rate[k], length));
                const Vec3 origin = only_moved ? o + map.shift : map(o);
                for (int axis = 0; axis < 3; ++axis) {
                    REQUIRE(same_bits(mapped.origin[axis][k], origin[axis]));
                    REQUIRE(same_bits(mapped.direction[axis][k], along[axis] / length));
                }
                REQUIRE(same_bits(mapped.t_max[k], t_max[k] * length));
                terms.end[k] = g.between(0, 3);
                nearest.plane[k] = g.chance(0.5) ? -1 : g.below(factors.view.soft + factors.view.sharp + 1) - 1;
                nearest.entering |= Lanes(g.chance(0.5)) << k;
            }
            alignas(64) double normal[3][RayPacket::size];
            const Lanes lanes = Lanes(g.below(1 << RayPacket::size));
            functions->convex_normals(factors.view, packet, terms.end, lanes, nearest, normal);
            for_each_lane(lanes, [&](int k) {
                const ConvexCrossing c{terms.end[k], bool(nearest.entering >> k & 1), int(nearest.plane[k])};
                Vec3 n = surface_normal(factors.view, c, rays[k].origin + rays[k].direction * c.t);
                if ((glm::dot(n, rays[k].direction) < 0) != c.entering) n = -n;
                for (int axis = 0; axis < 3; ++axis) REQUIRE(same_bits(normal[axis][k], n[axis]));
                alone += c.plane >= 0;
                entering += c.entering;
            });
        }
        CHECK(alone > 1'000);
        CHECK(entering > 1'000);
    }
}
