// Rays in arrays of their coordinates (structure of arrays), so that one vector instruction serves as
// many rays as the processor's vectors hold.
#pragma once
#include <cstdint>

#include "bounds/vec.hpp"

namespace deburr {

/// Bit k: ray k of a packet.
using Lanes = std::uint32_t;

/// How many they are.
inline std::uint64_t count(Lanes lanes) {
    static_assert(sizeof(Lanes) == 4);
    lanes -= lanes >> 1 & 0x55555555;
    lanes = (lanes & 0x33333333) + (lanes >> 2 & 0x33333333);
    return ((lanes + (lanes >> 4)) & 0x0f0f0f0f) * 0x01010101 >> 24;
}

/// Calls each(k) for the rays of `lanes`.
template <class Each>
void for_each_lane(Lanes lanes, Each each) {
    for (; lanes != 0; lanes &= lanes - 1) each(__builtin_ctz(lanes));
}

struct Ray {
    Vec3 origin;
    Vec3 direction;  // unit
};

struct RayPacket {
    static constexpr int size = 16;

    alignas(64) double origin[3][size], direction[3][size];
    // Each ray is asked for in [begin, t_max]; what lies beyond `end` need not be found.
    alignas(64) double begin[size], t_max[size], end[size];

    Ray ray(int k) const {
        return {{origin[0][k], origin[1][k], origin[2][k]}, {direction[0][k], direction[1][k], direction[2][k]}};
    }
};

/// What follows of rays where coordinates of the scene reach a scale, and how far the search for each has come.
struct RayTerms {
    alignas(64) double end[RayPacket::size];               // as far as counts still
    alignas(64) double inverse[3][RayPacket::size];        // reciprocal(direction)
    alignas(64) double coordinate_bound[RayPacket::size];  // of coordinates that are added
};

}  // namespace deburr
