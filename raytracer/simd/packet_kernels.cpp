#include "raytracer/simd/packet_kernels.hpp"

// This file is compiled once for each set of instructions: what is between HWY_BEFORE_NAMESPACE and
// HWY_AFTER_NAMESPACE, and the files whose names end in -inl, each time in a namespace of its own.
// Left out: what differs little from its neighbours, and vectors whose size is not known here.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytracer/simd/packet_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "raytracer/simd/convex_packet-inl.hpp"
#include "raytracer/simd/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace deburr {
namespace HWY_NAMESPACE {

bool prepare(RayPacket& rays, double scale, double farthest) {
    bool far = false;
    for (std::size_t first = 0; first < RayPacket::size; first += hn::Lanes(d)) {
        V coordinate_bound = hn::Zero(d);
        for (int k = 0; k < 3; ++k) {
            const V x = hn::Load(d, rays.direction[k] + first);
            const V inverse = select(hn::Abs(x) > number(1e-300), number(1) / x, hn::CopySign(number(1e300), x));
            hn::Store(inverse, d, rays.inverse[k] + first);
            coordinate_bound = hn::Max(coordinate_bound, hn::Abs(hn::Load(d, rays.origin[k] + first)));
        }
        hn::Store(number(scale) + coordinate_bound, d, rays.coordinate_bound + first);
        far |= !none(coordinate_bound > number(farthest));
    }
    return far;
}

// Where rays are within a box, as span_in() says.
struct Span {
    V lo, hi;
    HWY_INLINE Span(const Box& box, const RayPacket& rays, std::size_t first, V end) : lo(hn::Zero(d)), hi(end) {
        for (int k = 0; k < 3; ++k) {
            const V o = hn::Load(d, rays.origin[k] + first), inverse = hn::Load(d, rays.inverse[k] + first);
            const V a = (number(box.lo[k]) - o) * inverse, b = (number(box.hi[k]) - o) * inverse;
            lo = hn::Max(hn::Min(a, b), lo);
            hi = hn::Min(hn::Max(a, b), hi);
        }
    }
};

Lanes enter(const Box& box, const RayPacket& rays, Lanes lanes, PacketEntry& entry) {
    Lanes met = 0;
    V least[6], most[6];  // points, directions
    for (int k = 0; k < 6; ++k) {
        least[k] = number(infinity);
        most[k] = number(-infinity);
    }
    for (std::size_t first = 0; first < RayPacket::size; first += hn::Lanes(d)) {
        const Lanes part = part_of(lanes, first);
        if (part == 0) continue;
        const Span s(box, rays, first, hn::Load(d, rays.end + first));
        hn::Store(s.lo, d, entry.lo + first);
        hn::Store(s.hi, d, entry.hi + first);
        M meets = and_(s.lo <= s.hi, mask_of(part));
        V around[6];
        for (int k = 0; k < 3; ++k) {
            around[k + 3] = hn::Load(d, rays.direction[k] + first);
            around[k] = hn::Load(d, rays.origin[k] + first) + around[k + 3] * s.lo;
            // What is no number meets nothing, and must not be taken for the least or the most.
            meets = and_(meets, and_(around[k] == around[k], around[k + 3] == around[k + 3]));
        }
        met |= bits_of(meets) << first;
        for (int k = 0; k < 6; ++k) {
            least[k] = select(meets, hn::Min(least[k], around[k]), least[k]);
            most[k] = select(meets, hn::Max(most[k], around[k]), most[k]);
        }
    }
    for (int k = 0; k < 3; ++k) {
        entry.min_point[k] = hn::GetLane(hn::MinOfLanes(d, least[k]));
        entry.max_point[k] = hn::GetLane(hn::MaxOfLanes(d, most[k]));
        entry.min_direction[k] = hn::GetLane(hn::MinOfLanes(d, least[k + 3]));
        entry.max_direction[k] = hn::GetLane(hn::MaxOfLanes(d, most[k + 3]));
    }
    return met;
}

double longest_distance(const RayPacket& rays, Lanes lanes, const PacketEntry& entry) {
    V most = hn::Zero(d);
    for (std::size_t first = 0; first < RayPacket::size; first += hn::Lanes(d)) {
        const Lanes part = part_of(lanes, first);
        if (part == 0) continue;
        const V length =
            hn::Min(hn::Load(d, entry.hi + first), hn::Load(d, rays.end + first)) - hn::Load(d, entry.lo + first);
        most = select(mask_of(part), hn::Max(most, length), most);
    }
    return hn::GetLane(hn::MaxOfLanes(d, most));
}

Lanes spans_in_cell(const Box& cell, const RayPacket& rays, Lanes lanes, PacketSpans& spans) {
    Lanes in = 0;
    for (std::size_t first = 0; first < RayPacket::size; first += hn::Lanes(d)) {
        const Lanes part = part_of(lanes, first);
        if (part == 0) continue;
        const V t_max = hn::Load(d, rays.t_max + first);
        const Span s(cell, rays, first, t_max);
        const V pad = number(4 * epsilon) * (hn::Load(d, rays.coordinate_bound + first) + hn::Min(s.lo, s.hi));
        const V from = hn::Max(s.lo - pad, hn::Zero(d)), to = hn::Min(s.hi + pad, t_max);
        hn::Store(from, d, spans.from + first);
        hn::Store(to, d, spans.to + first);
        in |= (bits_of(and_(from <= to, from <= hn::Load(d, rays.end + first))) & part) << first;
    }
    return in;
}

Lanes plane_crossings(const AlphaPlane& plane, const RayPacket& rays, Lanes lanes, const PacketSpans& spans,
                      PacketCrossings& found) {
    Lanes crossed = 0;
    for (std::size_t first = 0; first < RayPacket::size; first += hn::Lanes(d)) {
        const Lanes part = part_of(lanes, first);
        if (part == 0) continue;
        const Rays r(rays, first);
        const V t = hn::Neg(r.distance(plane)) / r.rate(plane);
        hn::Store(t, d, found.t + first);
        hn::Store(number(-1), d, found.plane + first);
        const M within =
            and_(and_(t >= hn::Load(d, spans.from + first), t <= hn::Load(d, spans.to + first)), t < number(infinity));
        crossed |= (bits_of(within) & part) << first;
    }
    return crossed;
}

Lanes convex_crossings(const ConvexView& density, const RayPacket& rays, Lanes lanes, const PacketSpans& spans,
                       double scale, PacketCrossings& found, std::uint64_t& evaluations) {
    return crossings_of<false>(density, rays, lanes, spans, scale, &found, evaluations);
}

Lanes convex_any_crossings(const ConvexView& density, const RayPacket& rays, Lanes lanes, const PacketSpans& spans,
                           double scale, std::uint64_t& evaluations) {
    return crossings_of<true>(density, rays, lanes, spans, scale, nullptr, evaluations);
}

const PacketFunctions functions{
    prepare, enter, longest_distance, spans_in_cell, plane_crossings, convex_crossings, convex_any_crossings};

}  // namespace HWY_NAMESPACE
}  // namespace deburr
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deburr {

// Highway's own choice would need its library, which measures the processor's clock before main(): 3 ms.
std::vector<PacketInstructions> packet_instructions() {
    std::vector<PacketInstructions> there;
#if HWY_TARGETS & HWY_AVX3
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2"))
        there.push_back({"AVX-512", &N_AVX3::functions});
#endif
#if HWY_TARGETS & HWY_AVX2
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2"))
        there.push_back({"AVX2", &N_AVX2::functions});
#endif
#if HWY_TARGETS & HWY_SSE4
    if (__builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("pclmul"))
        there.push_back({"SSE4", &N_SSE4::functions});
#endif
    there.push_back({"baseline", &HWY_STATIC_DISPATCH(functions)});
    return there;
}

const PacketFunctions& packet_functions = *packet_instructions()[0].functions;

}  // namespace deburr
#endif
