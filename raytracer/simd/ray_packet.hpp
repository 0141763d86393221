// Packets: rays as a structure of arrays, so that one vector instruction works on as many rays as a register holds.
#pragma once
#include <cstdint>

#include "bounds/vec.hpp"

namespace deburr {

/// A set of rays of a packet: bit k stands for ray k.
using Lanes = std::uint32_t;

/// The number of rays in the set.
inline std::uint64_t count(Lanes lanes) {
    static_assert(sizeof(Lanes) == 4);
    lanes -= lanes >> 1 & 0x55555555;
    lanes = (lanes & 0x33333333) + (lanes >> 2 & 0x33333333);
    return ((lanes + (lanes >> 4)) & 0x0f0f0f0f) * 0x01010101 >> 24;
}

/// Calls each(k) for every ray k in the set, in ascending order.
template <class Each>
void for_each_lane(Lanes lanes, Each each) {
    for (; lanes != 0; lanes &= lanes - 1) each(__builtin_ctz(lanes));
}

/// A ray; distances along it are its parameters.
struct Ray {
    Vec3 origin;
    Vec3 direction;  // unit
};

/// Sixteen rays.
struct RayPacket {
    static constexpr int size = 16;

    alignas(64) double origin[3][size], direction[3][size];
    // A query looks for crossings in [begin, t_max]; one beyond `end` need not be found.
    alignas(64) double begin[size], t_max[size], end[size];

    Ray ray(int k) const {
        return {{origin[0][k], origin[1][k], origin[2][k]}, {direction[0][k], direction[1][k], direction[2][k]}};
    }
};

/// Values derived from a packet's rays for a search, and how far the search of each has come.
struct RayTerms {
    alignas(64) double end[RayPacket::size];               // crossings beyond it no longer count
    alignas(64) double inverse[3][RayPacket::size];        // reciprocal(direction)
    alignas(64) double coordinate_bound[RayPacket::size];  // largest magnitude of the terms of a point on the ray
};

}  // namespace deburr
