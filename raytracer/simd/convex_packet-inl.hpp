// Products of half-spaces along several rays at a time: the operations of bounds/convex_density.cpp, where each step is
// explained, in the same order.
#if defined(DEBURR_CONVEX_PACKET_INL) == defined(HWY_TARGET_TOGGLE)  // not yet included for this set of instructions
#ifdef DEBURR_CONVEX_PACKET_INL
#undef DEBURR_CONVEX_PACKET_INL
#else
#define DEBURR_CONVEX_PACKET_INL
#endif

#include <hwy/highway.h>

#include "bounds/root_finder.hpp"
#include "raytracer/simd/lanes-inl.hpp"
#include "raytracer/simd/packet_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace deburr {
namespace HWY_NAMESPACE {

constexpr double rounding = RootFinder::rounding;

// The product P of the soft factors and its derivative at a point of each ray.
struct Point {
    V P, slope;
};

// The factors along the rays. C is the stretch of a ray where P exceeds its level. N is the number of soft factors if
// it is known at compile time, else 0.
template <int N>
class Convex {
public:
    DEBURR_INLINE Convex(const ConvexView& density, const Rays& rays, std::uint64_t& evaluations)
        : soft_(N > 0 ? N : density.soft),
          evaluations_(evaluations),
          level_(number(density.complement ? 0.5 - rounding : 0.5 + rounding)) {
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
        for (int i = soft(); i < soft() + density.sharp; ++i)
            clip(rays.distance(density.planes[i]), rays.rate(density.planes[i]), i);
    }

    // Crossings in [lo, hi]: which rays have one, which of these go into C, and t and the index of the plane crossed
    // (−1: none alone).
    struct Found {
        DEBURR_INLINE Found() {}  // not defaulted: the compiler's would lack this instruction set
        M any, into;
        V t, plane;
    };

    // The rays among `rays` whose interval within all factors reaches [lo, hi].
    DEBURR_INLINE M meeting(M rays, V lo, V hi, V t_tolerance) const {
        return and_not(and_(rays, out_ - in_ > t_tolerance), or_(in_ > hi, out_ < lo));
    }

    // First crossings of `rays`, which must be among meeting().
    DEBURR_INLINE Found first(M rays, V lo, V hi, V t_tolerance) const {
        const M entering = in_ > lo;
        const V start = select(entering, in_, lo);
        const M alone = and_(and_(rays, entering), is_alone(plane_in_, start));
        const M asked = and_not(rays, alone);
        const Point p = at(start, asked);
        const M inside = and_(asked, p.P > level_);
        Found f;
        f.any = f.into = or_(alone, and_(inside, entering));
        f.t = start;
        f.plane = select(alone, plane_in_, if_sharp(plane_in_));

        M search = and_not(asked, inside);  // rays that look for a root from outside of C into it
        V s = start, base = hn::Zero(d), sign = number(1), to = select(out_ < hi, out_, hi);
        Point at_s = p;
        const M leaving = and_not(inside, entering);
        M back = leaving;
        if (!none(leaving)) {
            const M here = out_ <= hi;
            const M alone_out = and_(and_(leaving, here), is_alone(plane_out_, to));
            back = and_not(leaving, alone_out);
            const Point q = at(to, back);
            const M still = and_(back, q.P > level_);
            const M out = or_(alone_out, and_(still, here));
            back = and_not(back, still);
            f.any = or_(f.any, out);
            f.t = select(out, to, f.t);
            f.plane = select(alone_out, plane_out_, select(out, if_sharp(plane_out_), f.plane));
            // Mirrored search: backwards from a point beyond C.
            s = select(back, hn::Zero(d), s);
            base = select(back, to, base);
            sign = select(back, number(-1), sign);
            at_s = {select(back, q.P, at_s.P), select(back, hn::Neg(q.slope), at_s.slope)};
            to = select(back, number(infinity), to);
            search = or_(search, back);
        }
        if (none(search)) return f;
        const M rooted = newton(search, s, at_s, to, base, sign, t_tolerance);
        const M root_in = and_not(rooted, back);
        f.any = or_(f.any, or_(root_in, back));
        f.into = or_(f.into, root_in);
        // These rays leave C for certain: where rounding hides the root, the crossing is at the end.
        f.t = select(root_in, s, select(back, select(rooted, base - s, base), f.t));
        f.plane = select(or_(root_in, back), number(-1), f.plane);
        return f;
    }

    // The rays among `rays` (all of them meeting()) that have a crossing in [lo, hi].
    DEBURR_INLINE M any(M rays, V lo, V hi, V t_tolerance) const {
        const V from = hn::Max(in_, lo), to = hn::Min(hi, out_);
        const M inside = and_(rays, at(number(0.5) * (from + to), rays).P > level_);
        M found = and_(inside, or_(in_ > lo, out_ <= hi));
        M asked = and_not(inside, found);
        if (!none(asked)) {
            const M outside = and_(asked, at(lo, asked).P <= level_);
            asked = and_not(asked, outside);
            found = or_(found, or_(outside, and_(asked, at(hi, asked).P <= level_)));
        }
        const M search = and_not(rays, inside);
        return none(search) ? found : or_(found, and_(search, first(search, lo, hi, t_tolerance).any));
    }

private:
    DEBURR_INLINE int soft() const { return N > 0 ? N : soft_; }

    // Cuts [in_, out_] down to where α = a + b·t of factor `plane` is at most 0, its density ½ or more.
    DEBURR_INLINE void clip(V a, V b, int plane) {
        const V t = hn::Neg(a) / b, zero = hn::Zero(d);
        const M later = and_(b<zero, t> in_), sooner = and_(b > zero, t < out_);
        in_ = select(later, t, in_);
        plane_in_ = select(later, number(plane), plane_in_);
        out_ = select(sooner, t, out_);
        plane_out_ = select(sooner, number(plane), plane_out_);
        const M never = and_(b == zero, a > zero);
        in_ = select(never, number(infinity), in_);
        out_ = select(never, number(-infinity), out_);
    }

    // P and its derivative over the soft factors. Evaluations are counted for the rays in `asked`.
    DEBURR_INLINE Point at(V t, M asked) const {
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

    // `plane` where it names a sharp factor, else −1.
    DEBURR_INLINE V if_sharp(V plane) const { return select(plane >= number(soft()), plane, number(-1)); }

    // The rays whose crossing is that of one soft plane alone, since all other soft factors are 1.
    DEBURR_INLINE M is_alone(V plane, V t) const {
        M alone = plane < number(soft());
        for (int i = 0; i < soft(); ++i) alone = and_(alone, or_(plane == number(i), a_[i] + b_[i] * t <= number(-1)));
        return alone;
    }

    // Moves s to the root for the rays of `run` that have one before `to`; returns these. A ray's parameter is base +
    // sign·s.
    DEBURR_INLINE M newton(M run, V& s, Point p, V to, V base, V sign, V t_tolerance) const {
        const V one = number(1), two = number(2), three = number(3), four = number(4), zero = hn::Zero(d);
        M found = and_not(run, run);
        for (int k = 0; k < max_newton_steps; ++k) {
            const M there = and_(run, p.P >= number(0.5 - rounding));
            found = or_(found, and_(there, p.slope > zero));
            run = and_(and_not(run, there), p.slope > zero);
            if (none(run)) return found;
            const V x = two * p.P;
            const V step = p.P * (three * (one - x * x)) / (p.slope * (one + x * (four + x)));
            s = select(run, s + step, s);
            run = and_not(run, s > to);
            const M close =
                and_(run, or_(step <= t_tolerance, number(2.25) * rates_ * p.P * step * step <= t_tolerance * p.slope));
            found = or_(found, close);
            run = and_not(run, close);
            if (none(run)) return found;
            p = at(base + sign * s, run);
            p.slope = p.slope * sign;
        }
        return or_(found, run);
    }

    int soft_;
    std::uint64_t& evaluations_;
    V level_, in_, out_, rates_, plane_in_, plane_out_;
    V a_[N > 0 ? N : max_packet_factors], b_[N > 0 ? N : max_packet_factors];
};

// surface_normal() of convex_density.hpp at t for the rays in `asked`, turned against rays that enter.
DEBURR_INLINE void normals_of(const ConvexView& density, const Rays& rays, V t, V plane, M entering, M asked,
                              std::size_t first, double (*normal)[RayPacket::size]) {
    const V one = number(1), zero = hn::Zero(d);
    V x[3], sum[3] = {zero, zero, zero}, P = one;
    for (int k = 0; k < 3; ++k) x[k] = rays.origin[k] + rays.direction[k] * t;
    for (int i = 0; i < density.soft; ++i) {
        const AlphaPlane& p = density.planes[i];
        const V slope[3] = {number(p.slope.x), number(p.slope.y), number(p.slope.z)};
        const V alpha = slope[0] * x[0] + slope[1] * x[1] + slope[2] * x[2] + number(p.base);
        const V c = hn::Max(hn::Min(alpha, one), hn::Neg(one)), u = one - c;
        const V F = u * u * (number(2) + c) * number(0.25), share = P * (u * (one + c));
        for (int k = 0; k < 3; ++k) sum[k] = sum[k] * F + slope[k] * share;
        P = P * F;
    }
    for (int i = 0; i < density.soft + density.sharp; ++i) {
        const M alone = plane == number(i);
        for (int k = 0; k < 3; ++k) sum[k] = select(alone, number(density.planes[i].slope[k]), sum[k]);
    }
    const V length = hn::Sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
    const V scale = select(length > zero, one / length, one);
    for (int k = 0; k < 3; ++k) sum[k] = sum[k] * scale;
    store_against(sum, rays, entering, asked, first, normal);
}

// First crossings (or any, with `Any`) of the rays in `lanes`; returns those that have one.
template <int N, bool Any>
Lanes crossings_of(const ConvexView& density, const RayPacket& rays, Lanes lanes, const PacketSpans& spans,
                   double scale, PacketCrossings* found, std::uint64_t& evaluations) {
    Lanes crossed = 0, entering = 0;
    for (std::size_t first = 0; first < RayPacket::size; first += hn::Lanes(d)) {
        const Lanes part = part_of(lanes, first);
        if (part == 0) continue;
        const Convex<N> convex(density, Rays(rays, first), evaluations);
        const V lo = hn::Load(d, spans.from + first), hi = hn::Load(d, spans.to + first);
        const V t_tolerance = number(8 * epsilon) * (number(scale) + hn::Abs(lo));
        const M meeting = convex.meeting(mask_of(part), lo, hi, t_tolerance);
        if (none(meeting)) continue;
        if constexpr (Any) {
            crossed |= bits_of(convex.any(meeting, lo, hi, t_tolerance)) << first;
        } else {
            const auto f = convex.first(meeting, lo, hi, t_tolerance);
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
Lanes crossings_of(const ConvexView& density, const RayPacket& rays, Lanes lanes, const PacketSpans& spans,
                   double scale, PacketCrossings* found, std::uint64_t& evaluations) {
    switch (density.soft) {
        case 1: return crossings_of<1, Any>(density, rays, lanes, spans, scale, found, evaluations);
        case 2: return crossings_of<2, Any>(density, rays, lanes, spans, scale, found, evaluations);
        case 3: return crossings_of<3, Any>(density, rays, lanes, spans, scale, found, evaluations);
        default: return crossings_of<0, Any>(density, rays, lanes, spans, scale, found, evaluations);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace deburr
HWY_AFTER_NAMESPACE();

#endif
