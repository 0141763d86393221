// Rays in arrays of their coordinates (structure of arrays), so that one vector instruction serves as
// many rays as the processor's vectors hold.
#pragma once
#include <cstdint>

#include "bounds/vec.hpp"

namespace deburr {

/// Bit k: ray k of a packet.
using Lanes = std::uint32_t;

/// Calls each(k) for the rays of `lanes`.
template <class Each>
void for_each_lane(Lanes lanes, Each each) {
    for (; lanes != 0; lanes &= lanes - 1) each(__builtin_ctz(lanes));
}

struct RayPacket {
    static constexpr int size = 16;

    alignas(64) double origin[3][size], direction[3][size];
    alignas(64) double t_max[size], end[size];  // as far as is asked for; as far as counts still
    // Of these, by prepare():
    alignas(64) double inverse[3][size];        // reciprocal(direction)
    alignas(64) double coordinate_bound[size];  // of coordinates that are added
};

}  // namespace deburr
