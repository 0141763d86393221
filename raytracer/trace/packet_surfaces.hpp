// The surfaces that the rays of a packet found.
#pragma once
#include "raytracer/simd/ray_packet.hpp"
#include "raytracer/trace/nearest_crossing.hpp"

namespace deburr {

/// A FoundSurface for each ray, as a structure of arrays.
struct PacketSurfaces {
    Lanes found = 0;  // the rays that found a surface; the values of others are undefined
    alignas(64) double t[RayPacket::size], start[RayPacket::size], error[RayPacket::size];
    alignas(64) double normal[3][RayPacket::size];
    int solid[RayPacket::size], material[RayPacket::size];

    void set(int k, const FoundSurface& surface) {
        const Lanes bit = Lanes(1) << k;
        found &= ~bit;
        if (!(surface.crossing.t < infinity)) return;
        found |= bit;
        t[k] = surface.crossing.t;
        start[k] = surface.start;
        error[k] = surface.error;
        for (int axis = 0; axis < 3; ++axis) normal[axis][k] = surface.crossing.normal[axis];
        solid[k] = surface.solid;
        material[k] = surface.crossing.material;
    }
    /// Copies the surface of ray k from another packet, if it has one there.
    void set(int k, const PacketSurfaces& from) {
        found |= from.found & Lanes(1) << k;
        t[k] = from.t[k];
        start[k] = from.start[k];
        error[k] = from.error[k];
        for (int axis = 0; axis < 3; ++axis) normal[axis][k] = from.normal[axis][k];
        solid[k] = from.solid[k];
        material[k] = from.material[k];
    }
};

}  // namespace deburr
