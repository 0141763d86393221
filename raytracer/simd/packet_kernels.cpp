#include "raytracer/simd/packet_kernels.hpp"

#include "raytracer/simd/disabled_targets.hpp"

// This file is compiled once for each instruction set: the code between HWY_BEFORE_NAMESPACE and HWY_AFTER_NAMESPACE,
// and the files whose names end in -inl, each time in a namespace of its own.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytracer/simd/packet_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "raytracer/simd/box_walk-inl.hpp"
#include "raytracer/simd/convex_packet-inl.hpp"
#include "raytracer/simd/lanes-inl.hpp"
#include "raytracer/simd/product_sum_packet-inl.hpp"
#include "raytracer/simd/round_packet-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace deburr {
namespace HWY_NAMESPACE {

// Loads as many rays as a vector holds.
DEBURR_INLINE void load_rays(const Ray* rays, V* origin, V* direction) {
    static_assert(sizeof(Ray) == 6 * sizeof(double));
    const double* const numbers = &rays->origin.x;
#if HWY_TARGET == HWY_SCALAR
    for (int k = 0; k < 3; ++k) {
        origin[k] = number(numbers[k]);
        direction[k] = number(numbers[3 + k]);
    }
#else
    // Two vectors for each coordinate, in which origins and directions alternate.
    V a[3], b[3];
    hn::LoadInterleaved3(d, numbers, a[0], a[1], a[2]);
    hn::LoadInterleaved3(d, numbers + 3 * hn::Lanes(d), b[0], b[1], b[2]);
    for (int k = 0; k < 3; ++k) {
        origin[k] = hn::ConcatEven(d, b[k], a[k]);
        direction[k] = hn::ConcatOdd(d, b[k], a[k]);
    }
#endif
}

void load(RayPacket& packet, const Ray* rays, const double* t_max) {
    for (std::size_t first = 0; first < RayPacket::size; first += hn::Lanes(d)) {
        V o[3], x[3];
        load_rays(rays + first, o, x);
        for (int k = 0; k < 3; ++k) {
            hn::Store(o[k], d, packet.origin[k] + first);
            hn::Store(x[k], d, packet.direction[k] + first);
        }
        const V until = hn::LoadU(d, t_max + first);
        hn::Store(hn::Zero(d), d, packet.begin + first);
        hn::Store(until, d, packet.t_max + first);
        hn::Store(until, d, packet.end + first);
    }
}

Lanes prepare(const RayPacket& rays, double scale, double farthest, RayTerms& terms) {
    Lanes far = 0;
    for (std::size_t first = 0; first < RayPacket::size; first += hn::Lanes(d)) {
        V coordinate_bound = hn::Zero(d);
        for (int k = 0; k < 3; ++k) {
            const V x = hn::Load(d, rays.direction[k] + first);
            const V inverse = select(hn::Abs(x) > number(1e-300), number(1) / x, hn::CopySign(number(1e300), x));
            hn::Store(inverse, d, terms.inverse[k] + first);
            coordinate_bound = hn::Max(coordinate_bound, hn::Abs(hn::Load(d, rays.origin[k] + first)));
        }
        hn::Store(number(scale) + coordinate_bound, d, terms.coordinate_bound + first);
        hn::Store(hn::Load(d, rays.end + first), d, terms.end + first);
        far |= bits_of(coordinate_bound > number(farthest)) << first;
    }
    return far;
}

void map(const Affine& map, bool only_moved, const RayPacket& rays, const double* end, RayPacket& mapped,
         double* rate) {
    const Mat3& m = map.linear;
    for (std::size_t first = 0; first < RayPacket::size; first += hn::Lanes(d)) {
        V o[3], x[3], length = number(1);
        for (int k = 0; k < 3; ++k) {
            o[k] = hn::Load(d, rays.origin[k] + first);
            x[k] = hn::Load(d, rays.direction[k] + first);
        }
        if (!only_moved) {
            const auto linear = [&](const V* v, int k) {
                return number(m[0][k]) * v[0] + number(m[1][k]) * v[1] + number(m[2][k]) * v[2];
            };
            const V point[3] = {linear(o, 0), linear(o, 1), linear(o, 2)};
            const V along[3] = {linear(x, 0), linear(x, 1), linear(x, 2)};
            length = hn::Sqrt(along[0] * along[0] + along[1] * along[1] + along[2] * along[2]);
            for (int k = 0; k < 3; ++k) {
                o[k] = point[k];
                x[k] = along[k] / length;
            }
        }
        for (int k = 0; k < 3; ++k) {
            hn::Store(o[k] + number(map.shift[k]), d, mapped.origin[k] + first);
            hn::Store(x[k], d, mapped.direction[k] + first);
        }
        hn::Store(length, d, rate + first);
        hn::Store(hn::Zero(d), d, mapped.begin + first);
        const V t_max = hn::Load(d, rays.t_max + first) * length;
        // Rounded up, since a distance is rounded there and back: a crossing at `end` must be found.
        const V until = hn::Load(d, end + first) * length * number(1 + 4 * epsilon);
        hn::Store(t_max, d, mapped.t_max + first);
        hn::Store(hn::Min(t_max, until), d, mapped.end + first);
    }
}

// The intervals of rays within a box, as span_in() computes them.
struct Span {
    V lo, hi;
    DEBURR_INLINE Span(const Box& box, const RayPacket& rays, const RayTerms& terms, std::size_t first, V end)
        : lo(hn::Zero(d)), hi(end) {
        for (int k = 0; k < 3; ++k) {
            const V o = hn::Load(d, rays.origin[k] + first), inverse = hn::Load(d, terms.inverse[k] + first);
            const V a = (number(box.lo[k]) - o) * inverse, b = (number(box.hi[k]) - o) * inverse;
            lo = hn::Max(hn::Min(a, b), lo);
            hi = hn::Min(hn::Max(a, b), hi);
        }
    }
};

Lanes enter(const Box& box, const RayPacket& rays, const RayTerms& terms, Lanes lanes, PacketEntry& entry) {
    Lanes met = 0;
    V least[6], most[6];  // points, directions
    for (int k = 0; k < 6; ++k) {
        least[k] = number(infinity);
        most[k] = number(-infinity);
    }
    for (std::size_t first = 0; first < RayPacket::size; first += hn::Lanes(d)) {
        const Lanes part = part_of(lanes, first);
        if (part == 0) continue;
        const Span s(box, rays, terms, first, hn::Load(d, terms.end + first));
        hn::Store(s.lo, d, entry.lo + first);
        hn::Store(s.hi, d, entry.hi + first);
        M meets = and_(s.lo <= s.hi, mask_of(part));
        V around[6];
        for (int k = 0; k < 3; ++k) {
            around[k + 3] = hn::Load(d, rays.direction[k] + first);
            around[k] = hn::Load(d, rays.origin[k] + first) + around[k + 3] * s.lo;
            // A ray with NaN meets nothing, and must not affect the extremes.
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

double longest_distance(const RayTerms& terms, Lanes lanes, const PacketEntry& entry) {
    V most = hn::Zero(d);
    for (std::size_t first = 0; first < RayPacket::size; first += hn::Lanes(d)) {
        const Lanes part = part_of(lanes, first);
        if (part == 0) continue;
        const V length =
            hn::Min(hn::Load(d, entry.hi + first), hn::Load(d, terms.end + first)) - hn::Load(d, entry.lo + first);
        most = select(mask_of(part), hn::Max(most, length), most);
    }
    return hn::GetLane(hn::MaxOfLanes(d, most));
}

Lanes spans_in_cell(const Box& cell, const RayPacket& rays, const RayTerms& terms, Lanes lanes, PacketSpans& spans) {
    Lanes in = 0;
    for (std::size_t first = 0; first < RayPacket::size; first += hn::Lanes(d)) {
        const Lanes part = part_of(lanes, first);
        if (part == 0) continue;
        const V t_max = hn::Load(d, rays.t_max + first);
        const Span s(cell, rays, terms, first, t_max);
        const V pad = number(4 * epsilon) * (hn::Load(d, terms.coordinate_bound + first) + hn::Min(s.lo, s.hi));
        const V from = hn::Max(s.lo - pad, hn::Zero(d)), to = hn::Min(s.hi + pad, t_max);
        hn::Store(from, d, spans.from + first);
        hn::Store(to, d, spans.to + first);
        in |= (bits_of(and_(from <= to, from <= hn::Load(d, terms.end + first))) & part) << first;
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

Lanes keep_nearer(RayTerms& terms, PacketNearest& nearest, const PacketCrossings& crossings, Lanes lanes,
                  std::uint32_t primitive) {
    Lanes nearer = 0, as_near = 0;
    for (std::size_t first = 0; first < RayPacket::size; first += hn::Lanes(d)) {
        const Lanes part = part_of(lanes, first);
        if (part == 0) continue;
        const V t = hn::Load(d, crossings.t + first), end = hn::Load(d, terms.end + first);
        const M asked = mask_of(part), is_nearer = and_(asked, t < end);
        const auto keep = [&](V value, double* at) { hn::Store(select(is_nearer, value, hn::Load(d, at)), d, at); };
        keep(t, terms.end + first);
        keep(number(primitive), nearest.primitive + first);
        keep(hn::Load(d, crossings.plane + first), nearest.plane + first);
        nearer |= bits_of(is_nearer) << first;
        as_near |= bits_of(and_(asked, t == end)) << first;
    }
    nearest.found |= nearer;
    nearest.elsewhere &= ~nearer;
    nearest.entering = (nearest.entering & ~nearer) | (crossings.entering & nearer);
    return as_near;
}

// Calls at(rays, t, plane, entering, asked, first) for the nearest crossings of `lanes`, as many at a time as a vector
// holds.
template <class At>
DEBURR_INLINE void at_crossings(const RayPacket& packet, const double* end, Lanes lanes, const PacketNearest& nearest,
                                At at) {
    for (std::size_t first = 0; first < RayPacket::size; first += hn::Lanes(d)) {
        const Lanes part = part_of(lanes, first);
        if (part == 0) continue;
        at(Rays(packet, first), hn::Load(d, end + first), hn::Load(d, nearest.plane + first),
           mask_of(part_of(nearest.entering, first)), mask_of(part), first);
    }
}

void convex_normals(const ConvexView& density, const RayPacket& packet, const double* end, Lanes lanes,
                    const PacketNearest& nearest, double (*normal)[RayPacket::size]) {
    at_crossings(packet, end, lanes, nearest,
                 [&](const Rays& rays, V t, V plane, M entering, M asked, std::size_t first) {
                     normals_of(density, rays, t, plane, entering, asked, first, normal);
                 });
}

Lanes convex_crossings(const ConvexView& density, const RayPacket& rays, Lanes lanes, const PacketSpans& spans,
                       double scale, PacketCrossings& found, std::uint64_t& evaluations) {
    return crossings_of<false>(density, rays, lanes, spans, scale, &found, evaluations);
}

Lanes convex_any_crossings(const ConvexView& density, const RayPacket& rays, Lanes lanes, const PacketSpans& spans,
                           double scale, std::uint64_t& evaluations) {
    return crossings_of<true>(density, rays, lanes, spans, scale, nullptr, evaluations);
}

Lanes surface_crossings(const RoundSurface& surface, const RayPacket& rays, Lanes lanes, const PacketSpans& spans,
                        PacketCrossings& found) {
    return surface_crossings_of(surface, rays, lanes, spans, found);
}

void surface_normals(const RoundSurface& surface, const RayPacket& packet, const double* end, Lanes lanes,
                     const PacketNearest& nearest, double (*normal)[RayPacket::size]) {
    at_crossings(packet, end, lanes, nearest, [&](const Rays& rays, V t, V, M entering, M asked, std::size_t first) {
        surface_normals_of(surface, rays, t, entering, asked, first, normal);
    });
}

Lanes sum_crossings(const ProductSum& sum, const RayPacket& rays, Lanes lanes, const PacketSpans& spans, double scale,
                    PacketCrossings& found, RootCounters& counters) {
    return sum_crossings_of<false>(sum, rays, lanes, spans, scale, &found, counters);
}

Lanes sum_any_crossings(const ProductSum& sum, const RayPacket& rays, Lanes lanes, const PacketSpans& spans,
                        double scale, RootCounters& counters) {
    return sum_crossings_of<true>(sum, rays, lanes, spans, scale, nullptr, counters);
}

void sum_normals(const ProductSum& sum, const RayPacket& packet, const double* end, Lanes lanes,
                 const PacketNearest& nearest, double (*normal)[RayPacket::size]) {
    at_crossings(packet, end, lanes, nearest, [&](const Rays& rays, V t, V, M entering, M asked, std::size_t first) {
        sum_normals_of(sum, rays, t, entering, asked, first, normal);
    });
}

const PacketFunctions functions{load,
                                prepare,
                                map,
                                enter,
                                longest_distance,
                                spans_in_cell,
                                plane_crossings,
                                keep_nearer,
                                convex_normals,
                                convex_crossings,
                                convex_any_crossings,
                                surface_crossings,
                                surface_normals,
                                sum_crossings,
                                sum_any_crossings,
                                sum_normals,
                                walk_ray,
                                walk_beam};

}  // namespace HWY_NAMESPACE
}  // namespace deburr
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "raytracer/simd/instruction_sets-inl.hpp"

namespace deburr {

std::vector<Instructions<PacketFunctions>> packet_instructions() { DEBURR_INSTRUCTION_SETS(PacketFunctions, functions) }

const PacketFunctions& packet_functions = *packet_instructions()[0].functions;

}  // namespace deburr
#endif
