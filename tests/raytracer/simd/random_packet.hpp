// Packets of random rays, and comparisons of packet queries with those of single rays.
#pragma once
#include <bit>
#include <cstdint>

#include "random_case.hpp"
#include "raytracer/simd/packet_kernels.hpp"

namespace deburr {

constexpr double packet_scale = 3;  // bound of the coordinates

inline double t_tolerance(double t) { return 8 * epsilon * (packet_scale + t); }

inline bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

struct Packet {
    RayPacket rays;
    PacketSpans spans;
    Lanes lanes;

    explicit Packet(Gen& g) {
        lanes = Lanes(g.below(1 << RayPacket::size));
        for (int k = 0; k < RayPacket::size; ++k) {
            const Vec3 d = g.normal(), o = g.chance(0.2) ? Vec3(0.0) : g.point(0.5) - d * g.between(0, 2);
            for (int axis = 0; axis < 3; ++axis) {
                rays.origin[axis][k] = o[axis];
                rays.direction[axis][k] = d[axis];
            }
            rays.end[k] = g.chance(0.3) ? infinity : g.between(0, 5);
            spans.from[k] = g.chance(0.5) ? 0 : g.between(0, 1);
            spans.to[k] = spans.from[k] + (g.chance(0.1) ? 0 : g.between(0, 4));
        }
    }
    Vec3 origin(int k) const { return rays.ray(k).origin; }
    Vec3 direction(int k) const { return rays.ray(k).direction; }
};

}  // namespace deburr
