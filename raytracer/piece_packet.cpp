#include "raytracer/piece_packet.hpp"

#include <bit>

#include "bounds/root_finder.hpp"

// This file is compiled once for each set of instructions: what is between HWY_BEFORE_NAMESPACE and
// HWY_AFTER_NAMESPACE, each time in a namespace of its own.
// Left out: what differs little from its neighbours, and vectors whose size is not known here.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytracer/piece_packet.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace deburr {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<double, RayPacket::size>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

const D d;

// How the bounds are rounded (see bounds/convex_density.cpp).
constexpr double rounding = RootFinder::rounding;
constexpr int most_steps = 100;

HWY_INLINE V number(double x) { return hn::Set(d, x); }
HWY_INLINE V select(M m, V a, V b) { return hn::IfThenElse(m, a, b); }
HWY_INLINE M both(M a, M b) { return hn::And(a, b); }
HWY_INLINE M either(M a, M b) { return hn::Or(a, b); }
HWY_INLINE M but(M a, M b) { return hn::AndNot(b, a); }
HWY_INLINE bool none(M m) { return hn::AllFalse(d, m); }

HWY_INLINE M mask_of(Lanes bits) {
    const std::uint8_t bytes[8] = {std::uint8_t(bits), std::uint8_t(bits >> 8)};
    return hn::LoadMaskBits(d, bytes);
}
HWY_INLINE Lanes bits_of(M m) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, m, bytes);
    return Lanes(bytes[0]) | Lanes(bytes[1]) << 8;
}

// The bits of `lanes` from `first` on that one vector holds.
HWY_INLINE Lanes part_of(Lanes lanes, std::size_t first) { return (lanes >> first) & ((Lanes(1) << hn::Lanes(d)) - 1); }

struct Rays {
    V origin[3], direction[3];
    Rays(const RayPacket& rays, std::size_t first) {
        for (int k = 0; k < 3; ++k) {
            origin[k] = hn::Load(d, rays.origin[k] + first);
            direction[k] = hn::Load(d, rays.direction[k] + first);
        }
    }
    V distance(const AlphaPlane& p) const { return along(p, origin) + number(p.base); }
    V rate(const AlphaPlane& p) const { return along(p, direction); }

private:
    static HWY_INLINE V along(const AlphaPlane& p, const V* v) {
        return number(p.slope.x) * v[0] + number(p.slope.y) * v[1] + number(p.slope.z) * v[2];
    }
};

void prepare(RayPacket& rays, double scale) {
    for (std::size_t first = 0; first < RayPacket::size; first += hn::Lanes(d)) {
        V reach = hn::Zero(d);
        for (int k = 0; k < 3; ++k) {
            const V x = hn::Load(d, rays.direction[k] + first);
            const V inverse = select(hn::Abs(x) > number(1e-300), number(1) / x, hn::CopySign(number(1e300), x));
            hn::Store(inverse, d, rays.inverse[k] + first);
            reach = hn::Max(reach, hn::Abs(hn::Load(d, rays.origin[k] + first)));
        }
        hn::Store(number(scale) + reach, d, rays.reach + first);
    }
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
        M meets = both(s.lo <= s.hi, mask_of(part));
        V around[6];
        for (int k = 0; k < 3; ++k) {
            around[k + 3] = hn::Load(d, rays.direction[k] + first);
            around[k] = hn::Load(d, rays.origin[k] + first) + around[k + 3] * s.lo;
            // What is no number meets nothing, and must not be taken for the least or the most.
            meets = both(meets, both(around[k] == around[k], around[k + 3] == around[k + 3]));
        }
        met |= bits_of(meets) << first;
        for (int k = 0; k < 6; ++k) {
            least[k] = select(meets, hn::Min(least[k], around[k]), least[k]);
            most[k] = select(meets, hn::Max(most[k], around[k]), most[k]);
        }
    }
    for (int k = 0; k < 3; ++k) {
        entry.least_point[k] = hn::GetLane(hn::MinOfLanes(d, least[k]));
        entry.most_point[k] = hn::GetLane(hn::MaxOfLanes(d, most[k]));
        entry.least_direction[k] = hn::GetLane(hn::MinOfLanes(d, least[k + 3]));
        entry.most_direction[k] = hn::GetLane(hn::MaxOfLanes(d, most[k + 3]));
    }
    return met;
}

double longest_way(const RayPacket& rays, Lanes lanes, const PacketEntry& entry) {
    V most = hn::Zero(d);
    for (std::size_t first = 0; first < RayPacket::size; first += hn::Lanes(d)) {
        const Lanes part = part_of(lanes, first);
        if (part == 0) continue;
        const V way = hn::Min(hn::Load(d, entry.hi + first), hn::Load(d, rays.end + first)) - hn::Load(d, entry.lo + first);
        most = select(mask_of(part), hn::Max(most, way), most);
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
        const V pad = number(4 * epsilon) * (hn::Load(d, rays.reach + first) + hn::Min(s.lo, s.hi));
        const V from = hn::Max(s.lo - pad, hn::Zero(d)), to = hn::Min(s.hi + pad, t_max);
        hn::Store(from, d, spans.from + first);
        hn::Store(to, d, spans.to + first);
        in |= (bits_of(both(from <= to, from <= hn::Load(d, rays.end + first))) & part) << first;
    }
    return in;
}

Lanes plane_crossings(const AlphaPlane& plane, const RayPacket& rays, Lanes lanes, const PacketSpans& spans, PacketCrossings& found) {
    Lanes crossed = 0;
    for (std::size_t first = 0; first < RayPacket::size; first += hn::Lanes(d)) {
        const Lanes part = part_of(lanes, first);
        if (part == 0) continue;
        const Rays r(rays, first);
        const V t = hn::Neg(r.distance(plane)) / r.rate(plane);
        hn::Store(t, d, found.t + first);
        const M within = both(both(t >= hn::Load(d, spans.from + first), t <= hn::Load(d, spans.to + first)), t < number(infinity));
        crossed |= (bits_of(within) & part) << first;
    }
    return crossed;
}

struct Point {
    V P, slope;
};

// The rays' view of the factors, as in bounds/convex_density.cpp, where each step is explained. N: their
// number if known when compiled, else 0.
template <int N>
class Convex {
public:
    HWY_INLINE Convex(const ConvexView& density, const Rays& rays, std::uint64_t& evaluations)
        : soft_(N > 0 ? N : density.soft), evaluations_(evaluations), level_(number(density.complement ? 0.5 - rounding : 0.5 + rounding)) {
        in_ = number(-infinity);
        out_ = number(infinity);
        rates_ = hn::Zero(d);
        plane_in_ = plane_out_ = number(-1);
        for (int i = 0; i < soft(); ++i) {
            a_[i] = rays.distance(density.planes[i]);
            b_[i] = rays.rate(density.planes[i]);
            clip(a_[i], b_[i], i);
            rates_ = rates_ + b_[i] * b_[i];
        }
        for (int i = soft(); i < soft() + density.sharp; ++i) clip(rays.distance(density.planes[i]), rays.rate(density.planes[i]), i);
    }

    // What is found in [lo, hi]: rays' t and plane where it is, and whether they go into C.
    struct Found {
        M any, into;
        V t, plane;
    };

    HWY_INLINE M meeting(M rays, V lo, V hi, V negligible) const {
        return but(both(rays, out_ - in_ > negligible), either(in_ > hi, out_ < lo));
    }

    // Of `rays`, which meet C.
    HWY_INLINE Found first(M rays, V lo, V hi, V negligible) const {
        const M entering = in_ > lo;
        const V start = select(entering, in_, lo);
        const M alone = both(both(rays, entering), is_alone(plane_in_, start));
        const M asked = but(rays, alone);
        const Point p = at(start, asked);
        const M inside = both(asked, p.P > level_);
        Found f;
        f.any = f.into = either(alone, both(inside, entering));
        f.t = start;
        f.plane = select(alone, plane_in_, if_sharp(plane_in_));

        M search = but(asked, inside);  // from outside of C into it
        V s = start, base = hn::Zero(d), sign = number(1), to = select(out_ < hi, out_, hi);
        Point at_s = p;
        const M leaving = but(inside, entering);
        M back = leaving;
        if (!none(leaving)) {
            const M here = out_ <= hi;
            const M alone_out = both(both(leaving, here), is_alone(plane_out_, to));
            back = but(leaving, alone_out);
            const Point q = at(to, back);
            const M still = both(back, q.P > level_);
            const M out = either(alone_out, both(still, here));
            back = but(back, still);
            f.any = either(f.any, out);
            f.t = select(out, to, f.t);
            f.plane = select(alone_out, plane_out_, select(out, if_sharp(plane_out_), f.plane));
            // Mirrored: backwards from where it is outside again.
            s = select(back, hn::Zero(d), s);
            base = select(back, to, base);
            sign = select(back, number(-1), sign);
            at_s = {select(back, q.P, at_s.P), select(back, hn::Neg(q.slope), at_s.slope)};
            to = select(back, number(infinity), to);
            search = either(search, back);
        }
        if (none(search)) return f;
        const M rooted = newton(search, s, at_s, to, base, sign, negligible);
        const M root_in = but(rooted, back);
        f.any = either(f.any, either(root_in, back));
        f.into = either(f.into, root_in);
        // Out of C always: where rounding hides the root, at the end.
        f.t = select(root_in, s, select(back, select(rooted, base - s, base), f.t));
        f.plane = select(either(root_in, back), number(-1), f.plane);
        return f;
    }

    HWY_INLINE M any(M rays, V lo, V hi, V negligible) const {
        const V from = hn::Max(in_, lo), to = hn::Min(hi, out_);
        const M inside = both(rays, at(number(0.5) * (from + to), rays).P > level_);
        M found = both(inside, either(in_ > lo, out_ <= hi));
        M asked = but(inside, found);
        if (!none(asked)) {
            const M outside = both(asked, at(lo, asked).P <= level_);
            asked = but(asked, outside);
            found = either(found, either(outside, both(asked, at(hi, asked).P <= level_)));
        }
        const M search = but(rays, inside);
        return none(search) ? found : either(found, both(search, first(search, lo, hi, negligible).any));
    }

private:
    HWY_INLINE int soft() const { return N > 0 ? N : soft_; }

    HWY_INLINE void clip(V a, V b, int plane) {
        const V t = hn::Neg(a) / b, zero = hn::Zero(d);
        const M later = both(b < zero, t > in_), sooner = both(b > zero, t < out_);
        in_ = select(later, t, in_);
        plane_in_ = select(later, number(plane), plane_in_);
        out_ = select(sooner, t, out_);
        plane_out_ = select(sooner, number(plane), plane_out_);
        const M never = both(b == zero, a > zero);
        in_ = select(never, number(infinity), in_);
        out_ = select(never, number(-infinity), out_);
    }

    // Of the soft factors; counted for those who ask.
    HWY_INLINE Point at(V t, M asked) const {
        evaluations_ += hn::CountTrue(d, asked);
        const V one = number(1), two = number(2), quarter = number(0.25), three_quarters = number(0.75);
        Point p{one, hn::Zero(d)};
        for (int i = 0; i < soft(); ++i) {
            const V c = hn::Max(hn::Min(a_[i] + b_[i] * t, one), hn::Neg(one)), u = one - c;
            const V F = u * u * (two + c) * quarter;
            p.slope = p.slope * F - p.P * (three_quarters * u * (one + c) * b_[i]);
            p.P = p.P * F;
        }
        return p;
    }

    HWY_INLINE V if_sharp(V plane) const { return select(plane >= number(soft()), plane, number(-1)); }

    HWY_INLINE M is_alone(V plane, V t) const {
        M alone = plane < number(soft());
        for (int i = 0; i < soft(); ++i) alone = both(alone, either(plane == number(i), a_[i] + b_[i] * t <= number(-1)));
        return alone;
    }

    // Moves s to the root, for those of `run` that have one before `to`: they are returned.
    HWY_INLINE M newton(M run, V& s, Point p, V to, V base, V sign, V negligible) const {
        const V one = number(1), two = number(2), three = number(3), four = number(4), zero = hn::Zero(d);
        M found = but(run, run);
        for (int k = 0; k < most_steps; ++k) {
            const M there = both(run, p.P >= number(0.5 - rounding));
            found = either(found, both(there, p.slope > zero));
            run = both(but(run, there), p.slope > zero);
            if (none(run)) return found;
            const V x = two * p.P;
            const V step = p.P * (three * (one - x * x)) / (p.slope * (one + x * (four + x)));
            s = select(run, s + step, s);
            run = but(run, s > to);
            const M close = both(run, either(step <= negligible, number(2.25) * rates_ * p.P * step * step <= negligible * p.slope));
            found = either(found, close);
            run = but(run, close);
            if (none(run)) return found;
            p = at(base + sign * s, run);
            p.slope = p.slope * sign;
        }
        return either(found, run);
    }

    int soft_;
    std::uint64_t& evaluations_;
    V level_, in_, out_, rates_, plane_in_, plane_out_;
    V a_[N > 0 ? N : most_packet_factors], b_[N > 0 ? N : most_packet_factors];
};

template <int N, bool Any>
Lanes crossings_of(const ConvexView& density, const RayPacket& rays, Lanes lanes, const PacketSpans& spans, double scale,
                   PacketCrossings* found, std::uint64_t& evaluations) {
    Lanes crossed = 0, entering = 0;
    for (std::size_t first = 0; first < RayPacket::size; first += hn::Lanes(d)) {
        const Lanes part = part_of(lanes, first);
        if (part == 0) continue;
        const Convex<N> convex(density, Rays(rays, first), evaluations);
        const V lo = hn::Load(d, spans.from + first), hi = hn::Load(d, spans.to + first);
        const V negligible = number(8 * epsilon) * (number(scale) + lo);
        const M meeting = convex.meeting(mask_of(part), lo, hi, negligible);
        if (none(meeting)) continue;
        if constexpr (Any) {
            crossed |= bits_of(convex.any(meeting, lo, hi, negligible)) << first;
        } else {
            const auto f = convex.first(meeting, lo, hi, negligible);
            hn::Store(f.t, d, found->t + first);
            hn::Store(f.plane, d, found->plane + first);
            crossed |= bits_of(f.any) << first;
            entering |= (density.complement ? bits_of(f.any) & ~bits_of(f.into) : bits_of(f.into)) << first;
        }
    }
    if constexpr (!Any) found->entering = entering;
    return crossed;
}

template <bool Any>
Lanes crossings_of(const ConvexView& density, const RayPacket& rays, Lanes lanes, const PacketSpans& spans, double scale,
                   PacketCrossings* found, std::uint64_t& evaluations) {
    switch (density.soft) {
        case 1: return crossings_of<1, Any>(density, rays, lanes, spans, scale, found, evaluations);
        case 2: return crossings_of<2, Any>(density, rays, lanes, spans, scale, found, evaluations);
        case 3: return crossings_of<3, Any>(density, rays, lanes, spans, scale, found, evaluations);
        default: return crossings_of<0, Any>(density, rays, lanes, spans, scale, found, evaluations);
    }
}

Lanes convex_crossings(const ConvexView& density, const RayPacket& rays, Lanes lanes, const PacketSpans& spans, double scale,
                       PacketCrossings& found, std::uint64_t& evaluations) {
    return crossings_of<false>(density, rays, lanes, spans, scale, &found, evaluations);
}

Lanes convex_occlusions(const ConvexView& density, const RayPacket& rays, Lanes lanes, const PacketSpans& spans, double scale,
                        std::uint64_t& evaluations) {
    return crossings_of<true>(density, rays, lanes, spans, scale, nullptr, evaluations);
}

const PacketFunctions functions{prepare, enter, longest_way, spans_in_cell, plane_crossings, convex_crossings, convex_occlusions};

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
    if (__builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("pclmul")) there.push_back({"SSE4", &N_SSE4::functions});
#endif
    there.push_back({"baseline", &HWY_STATIC_DISPATCH(functions)});
    return there;
}

const PacketFunctions& packet_functions = *packet_instructions()[0].functions;

}  // namespace deburr
#endif
