// Round coordinates and surfaces of round parts along several rays at a time: the operations of RoundOnRay
// (bounds/round_coordinate.cpp) and RoundSurface (bounds/round_product.cpp) in the same order.
#if defined(DEBURR_ROUND_PACKET_INL) == defined(HWY_TARGET_TOGGLE)  // not yet included for this set of instructions
#ifdef DEBURR_ROUND_PACKET_INL
#undef DEBURR_ROUND_PACKET_INL
#else
#define DEBURR_ROUND_PACKET_INL
#endif

#include <hwy/highway.h>

#include "bounds/round_product.hpp"
#include "raytracer/simd/lanes-inl.hpp"
#include "raytracer/simd/packet_kernels.hpp"
#include "raytracer/simd/torus_packet-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace deburr {
namespace HWY_NAMESPACE {

// A round coordinate u along each ray. Coordinates of circles (tori) are not supported, except by gradient().
class RoundOnRays {
public:
    DEBURR_INLINE RoundOnRays() {}  // not defaulted: the compiler's would lack this instruction set
    DEBURR_INLINE void set(const RoundCoordinate& coordinate, const Rays& rays) {
        coordinate_ = &coordinate;
        V away[3], across[3];
        for (int k = 0; k < 3; ++k) {
            away[k] = rays.origin[k] - number(coordinate.center[k]);
            across[k] = rays.direction[k];
        }
        const V whole = dot(rays.direction, rays.direction), zero = hn::Zero(d);
        height_ = climb_ = zero;
        if (!is_point()) {
            height_ = dot(coordinate.axis, away);
            climb_ = dot(coordinate.axis, rays.direction);
            for (int k = 0; k < 3; ++k) {
                away[k] = away[k] - number(coordinate.axis[k]) * height_;
                across[k] = across[k] - number(coordinate.axis[k]) * climb_;
            }
        }
        square_ = dot(across, across);
        square_ = select(square_ <= number(16 * epsilon * epsilon) * whole, zero, square_);
        nearest_ = select(square_ > zero, hn::Neg(dot(away, across)) / square_, zero);
        V foot[3];
        for (int k = 0; k < 3; ++k) foot[k] = away[k] + nearest_ * across[k];
        least_ = dot(foot, foot);
    }

    // u and its derivative at t.
    DEBURR_INLINE V at(V t) const {
        const V s = distance(t);
        if (is_point()) return s;
        return number(coordinate_->across) * s + number(coordinate_->along) * height(t);
    }

    DEBURR_INLINE V slope(V t) const {
        const V s = distance(t), zero = hn::Zero(d);
        const V rate = select(s > zero, square_ * (t - nearest_) / s, zero);
        if (is_point()) return rate;
        return number(coordinate_->across) * rate + number(coordinate_->along) * climb_;
    }

    struct Interval {
        V lo, hi;
    };
    // The range of u in [t0, t1].
    DEBURR_INLINE Interval range(V t0, V t1) const {
        const V a = at(t0), b = at(t1);
        if (is_point()) return {distance(clamped(nearest_, t0, t1)), most(a, b)};
        Interval u{least(a, b), most(a, b)};
        const double across = coordinate_->across;
        if (across == 0) return u;
        const V k = number(-coordinate_->along) * climb_ / number(across);
        const M turns = k * k < square_;
        if (none(turns)) return u;
        const V turn = nearest_ + k * hn::Sqrt(least_ / (square_ * (square_ - k * k)));
        const M between = and_(turns, and_(turn > t0, turn < t1));
        const V value = at(turn);
        return {select(between, least(u.lo, value), u.lo), select(between, most(u.hi, value), u.hi)};
    }

    // Upper bounds of |u′| and |u″| in [t0, t1].
    DEBURR_INLINE V max_slope(V t0, V t1) const { return most(hn::Abs(slope(t0)), hn::Abs(slope(t1))); }

    DEBURR_INLINE V max_curvature(V t0, V t1) const {
        const V s = distance(clamped(nearest_, t0, t1)), zero = hn::Zero(d);
        const V bend = select(square_ == zero, zero,
                              select(s > zero, square_ * least(number(1), least_ / (s * s)) / s, number(infinity)));
        return number(std::abs(coordinate_->across)) * bend;
    }

    // The crossings of u with a level, in order of t. Only those whose mask is set exist.
    struct Crossings {
        V first, second;
        M has_first, has_second;
    };
    DEBURR_INLINE Crossings crossings(V level) const {
        const RoundCoordinate& c = *coordinate_;
        const V zero = hn::Zero(d);
        const V rate = is_point() ? zero : number(c.along) * climb_;
        const V room = is_point() ? level : level - number(c.along) * height(nearest_);
        const V k = number(is_point() ? 1 : c.across);
        const V A = k * k * square_ - rate * rate, B = room * rate, C = k * k * least_ - room * room;
        const V discriminant = B * B - A * C;
        const M real = discriminant >= zero;
        const V q = hn::Neg(B + hn::CopySign(hn::Sqrt(discriminant), B));
        const V at_A = q / A, at_C = select(q != zero, C / q, hn::Neg(at_A));
        const M quadratic = A != zero;
        const V p0 = least(at_A, at_C), p1 = select(quadratic, most(at_A, at_C), at_C);
        const auto counts = [&](V p) {
            return and_(and_(real, hn::Abs(p) < number(infinity)), (room - rate * p) * k >= zero);
        };
        return {nearest_ + p0, nearest_ + p1, and_(quadratic, counts(p0)), and_(counts(p1), or_(quadratic, q != zero))};
    }

    // Cuts [lo, hi] down to where u is at most `level`.
    DEBURR_INLINE void clip(V level, V& lo, V& hi) const {
        const Crossings c = crossings(level);
        const M both = and_(c.has_first, c.has_second), one = hn::Xor(c.has_first, c.has_second);
        const V only = select(c.has_first, c.first, c.second);
        const M falls = and_(one, slope(only) < hn::Zero(d)), rises = and_not(one, falls);
        const M outside = and_not(hn::Not(or_(both, one)), at(lo) <= level);
        lo = select(both, most(lo, c.first), select(falls, most(lo, only), lo));
        hi = select(both, least(hi, c.second), select(rises, least(hi, only), hi));
        hi = select(outside, number(-infinity), hi);
    }

    // ∇u at the points x: unit vectors, or 0 where there is none.
    static DEBURR_INLINE void gradient(const RoundCoordinate& c, const V* x, V* g) {
        const V zero = hn::Zero(d);
        V away[3];
        for (int k = 0; k < 3; ++k) away[k] = x[k] - number(c.center[k]);
        const bool point = c.kind == RoundCoordinate::Kind::point;
        V t = zero;
        if (!point) {
            t = dot(c.axis, away);
            for (int k = 0; k < 3; ++k) away[k] = away[k] - number(c.axis[k]) * t;
        }
        const V length = hn::Sqrt(dot(away, away));
        if (c.kind == RoundCoordinate::Kind::circle) {
            for (int k = 0; k < 3; ++k)
                g[k] =
                    (length - number(c.ring)) * select(length > zero, away[k] / length, zero) + t * number(c.axis[k]);
            const V whole = hn::Sqrt(dot(g, g));
            for (int k = 0; k < 3; ++k) g[k] = select(whole > zero, g[k] / whole, zero);
            return;
        }
        for (int k = 0; k < 3; ++k) {
            g[k] = select(length > zero, away[k] / length, zero);
            if (!point) g[k] = number(c.across) * g[k] + number(c.along) * number(c.axis[k]);
        }
    }

private:
    DEBURR_INLINE bool is_point() const { return coordinate_->kind == RoundCoordinate::Kind::point; }
    DEBURR_INLINE V distance(V t) const {
        const V past = t - nearest_;
        return hn::Sqrt(least_ + square_ * past * past);
    }
    DEBURR_INLINE V height(V t) const { return height_ + climb_ * t; }

    const RoundCoordinate* coordinate_ = nullptr;
    V nearest_, least_, square_, height_, climb_;
};

// First crossings of the rays in `lanes` with a RoundSurface; returns those that have one.
DEBURR_INLINE Lanes surface_crossings_of(const RoundSurface& surface, const RayPacket& rays, Lanes lanes,
                                         const PacketSpans& spans, PacketCrossings& found) {
    Lanes crossed = 0;
    found.entering = 0;
    const V zero = hn::Zero(d), offset = number(surface.offset);
    for (std::size_t first = 0; first < RayPacket::size; first += hn::Lanes(d)) {
        const Lanes part = part_of(lanes, first);
        if (part == 0) continue;
        const V lo = hn::Load(d, spans.from + first), hi = hn::Load(d, spans.to + first);
        const M asked = mask_of(part),
                complement = surface.complement ? hn::Not(hn::Xor(asked, asked)) : hn::Xor(asked, asked);
        const auto keep = [&](M any, M enters, V t) {
            hn::Store(t, d, found.t + first);
            hn::Store(number(-1), d, found.plane + first);
            crossed |= bits_of(any) << first;
            found.entering |= bits_of(and_(any, enters)) << first;
        };
        if (surface.is_torus()) {
            const TorusOnRays torus(surface.coordinate, surface.offset, surface.complement, Rays(rays, first), lo, hi);
            const auto f = torus.first(asked);
            keep(f.any, hn::Xor(f.into, complement), f.t);
            continue;
        }
        RoundOnRays on_rays;
        on_rays.set(surface.coordinate, Rays(rays, first));
        const M starts_inside = hn::Xor(on_rays.at(lo) <= offset, complement);
        const auto c = on_rays.crossings(offset);
        const auto enters = [&](V t) { return hn::Xor(on_rays.slope(t) < zero, complement); };
        // A crossing at lo itself may be included in the side that the ray starts on.
        const auto counts = [&](M has, V t) {
            return and_(and_(asked, has), and_(and_(t >= lo, t <= hi), hn::Xor(enters(t), starts_inside)));
        };
        const M at_first = counts(c.has_first, c.first), at_second = and_not(counts(c.has_second, c.second), at_first);
        const V t = select(at_first, c.first, c.second);
        keep(or_(at_first, at_second), enters(t), t);
    }
    return crossed;
}

// Unit normals of a RoundSurface at t for the rays in `asked`, turned against rays that enter.
DEBURR_INLINE void surface_normals_of(const RoundSurface& surface, const Rays& rays, V t, M entering, M asked,
                                      std::size_t first, double (*normal)[RayPacket::size]) {
    V x[3], n[3];
    for (int k = 0; k < 3; ++k) x[k] = rays.origin[k] + rays.direction[k] * t;
    RoundOnRays::gradient(surface.coordinate, x, n);
    const V zero = hn::Zero(d);
    const M none_there = and_(and_(n[0] == zero, n[1] == zero), n[2] == zero);
    for (int k = 0; k < 3; ++k) n[k] = select(none_there, rays.direction[k], surface.complement ? hn::Neg(n[k]) : n[k]);
    store_against(n, rays, entering, asked, first, normal);
}

}  // namespace HWY_NAMESPACE
}  // namespace deburr
HWY_AFTER_NAMESPACE();

#endif
