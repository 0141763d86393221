// Tori along several rays at a time: the operations of TorusOnRay (bounds/torus_on_ray.cpp) in the same order.
#if defined(DEBURR_TORUS_PACKET_INL) == defined(HWY_TARGET_TOGGLE)  // not yet included for this set of instructions
#ifdef DEBURR_TORUS_PACKET_INL
#undef DEBURR_TORUS_PACKET_INL
#else
#define DEBURR_TORUS_PACKET_INL
#endif

#include <hwy/highway.h>

#include "bounds/root_finder.hpp"
#include "bounds/torus_on_ray.hpp"
#include "raytracer/simd/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace deburr {
namespace HWY_NAMESPACE {

DEBURR_INLINE V dot(const V* a, const V* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
DEBURR_INLINE V dot(const Vec3& a, const V* b) { return number(a.x) * b[0] + number(a.y) * b[1] + number(a.z) * b[2]; }

// A torus along the rays in [t0, t1], as a polynomial of degree four in u = t − middle that is positive inside.
class TorusOnRays {
public:
    DEBURR_INLINE TorusOnRays(const RoundCoordinate& circle, double tube, bool complement, const Rays& rays, V t0, V t1)
        : ring_(number(circle.ring)), tube_(number(tube)), t0_(t0), t1_(t1) {
        V away[3], y[3], across[3], rate[3];
        for (int k = 0; k < 3; ++k) away[k] = rays.origin[k] - number(circle.center[k]);
        const V speed = dot(rays.direction, rays.direction);
        middle_ = hn::Neg(dot(away, rays.direction)) / speed;
        for (int k = 0; k < 3; ++k) y[k] = away[k] + middle_ * rays.direction[k];
        height_ = dot(circle.axis, y);
        climb_ = dot(circle.axis, rays.direction);
        for (int k = 0; k < 3; ++k) {
            across[k] = y[k] - number(circle.axis[k]) * height_;
            rate[k] = rays.direction[k] - number(circle.axis[k]) * climb_;
        }
        start_square_ = dot(across, across);
        start_rate_ = dot(across, rate);
        rate_square_ = dot(rate, rate);

        const double R = circle.ring, reach = (R + tube) * TorusOnRay::larger;
        const V square = dot(y, y);
        const V half = hn::Sqrt(most(number(reach * reach) - square, hn::Zero(d)) / speed);
        lo_ = most(t0 - middle_, hn::Neg(half));
        hi_ = least(t1 - middle_, half);
        const V k = square + number((R - tube) * (R + tube));
        const double four = 4 * R * R, noise = RootFinder::rounding * (2 * four * (reach * reach));
        c0_ = number(four) * start_square_ - k * k - number(complement ? -noise : noise);
        c1_ = number(2 * four) * start_rate_;
        c2_ = number(four) * rate_square_ - number(2) * k * speed;
        c4_ = hn::Neg(speed * speed);
        least_length_ = number(16 * epsilon) * (half + hn::Abs(middle_));
        tolerance_ = number(TorusOnRay::near_enough * tube) / hn::Sqrt(speed);
    }

    // First crossings of `rays`: which of them have one, and which of these go into the torus.
    struct Found {
        DEBURR_INLINE Found() {}  // not defaulted: the compiler's would lack this instruction set
        M any, into;
        V t;
    };
    DEBURR_INLINE Found first(M rays) const {
        const V zero = hn::Zero(d);
        V from = lo_, width = hi_ - lo_, at_from = value(lo_);
        V root_from = lo_, root_to = lo_, at_root_from = zero, at_root_to = zero;
        M in = and_(lo_<hi_, at_from> zero), run = and_(rays, lo_ < hi_);
        Found f;
        f.any = f.into = and_not(run, run);
        while (!none(run)) {
            const V to = least(from + width, hi_), length = to - from, at_to = value(to), square = length * length;
            const V a1 = length * slope(from), a2 = square * (c2_ + number(6) * c4_ * (from * from)),
                    a3 = square * length * (number(4) * c4_ * from);
            const M first = at_from + number(0.25) * a1 > zero;
            const M second = at_from + number(0.5) * a1 + a2 * number(1 / 6.0) > zero;
            const M third = at_from + number(0.75) * a1 + number(0.5) * a2 + number(0.25) * a3 > zero;
            const M last = at_to > zero;
            M once = hn::Xor(in, first), often = and_not(run, run);
            const auto change = [&](M a, M b) {
                const M changes = hn::Xor(a, b);
                often = or_(often, and_(once, changes));
                once = or_(once, changes);
            };
            change(first, second);
            change(second, third);
            change(third, last);
            const M halved = and_(and_(run, often), length > least_length_);
            const M crosses = and_(and_not(run, halved), hn::Xor(in, last));
            root_from = select(crosses, from, root_from);
            root_to = select(crosses, to, root_to);
            at_root_from = select(crosses, at_from, at_root_from);
            at_root_to = select(crosses, at_to, at_root_to);
            f.any = or_(f.any, crosses);
            f.into = or_(f.into, and_(crosses, last));
            width = select(halved, number(0.5) * length, number(2) * length);
            from = select(halved, from, to);
            at_from = select(halved, at_from, at_to);
            in = or_(and_(in, halved), and_not(last, halved));
            run = and_(and_not(run, crosses), from < hi_);
        }
        f.t = none(f.any) ? zero : root(f.any, root_from, root_to, at_root_from, at_root_to);
        return f;
    }

private:
    // The polynomial and its derivative.
    DEBURR_INLINE V value(V u) const { return c0_ + u * (c1_ + u * (c2_ + u * (u * c4_))); }
    DEBURR_INLINE V slope(V u) const { return c1_ + u * (number(2) * c2_ + u * (number(4) * u * c4_)); }

    // The roots between `from` and `to` for the rays in `run`, as parameters t.
    DEBURR_INLINE V root(M run, V from, V to, V at_from, V at_to) const {
        const V zero = hn::Zero(d);
        const M in = at_from > zero;
        V a = from, b = to, u = from + (to - from) * (at_from / (at_from - at_to));
        for (int k = 0; k < TorusOnRay::max_steps && !none(run); ++k) {
            const V f = value(u);
            const M other = hn::Xor(f > zero, in);
            a = select(other, a, u);
            b = select(other, u, b);
            V next = u - f / slope(u);
            next = select(and_(next > a, next < b), next, number(0.5) * (a + b));
            const V moved = hn::Abs(next - u);
            u = select(run, next, u);
            run = and_not(run, moved <= tolerance_);
        }
        const V nearer = nearer_by_distance(u);
        u = select(and_(nearer >= from, nearer <= to), nearer, u);
        return least(most(u + middle_, t0_), t1_);
    }

    // One step of Newton's method for the distance from the circle, whose rounding is less than the polynomial's.
    DEBURR_INLINE V nearer_by_distance(V u) const {
        const V s = hn::Sqrt(start_square_ + u * (number(2) * start_rate_ + u * rate_square_)), out = s - ring_;
        const V h = height_ + climb_ * u, distance = hn::Sqrt(out * out + h * h);
        const V rate = (out * ((start_rate_ + u * rate_square_) / s) + h * climb_) / distance;
        return u - (distance - tube_) / rate;
    }

    V ring_, tube_, t0_, t1_, middle_, lo_, hi_, c0_, c1_, c2_, c4_;
    V start_square_, start_rate_, rate_square_, height_, climb_, least_length_, tolerance_;
};

}  // namespace HWY_NAMESPACE
}  // namespace deburr
HWY_AFTER_NAMESPACE();

#endif
