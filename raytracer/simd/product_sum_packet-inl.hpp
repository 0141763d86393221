// First crossings of several rays at a time with the surface of a sum of products (bounds/product_sum.hpp), and the
// normals there.
#if defined(DEBURR_PRODUCT_SUM_PACKET_INL) == defined(HWY_TARGET_TOGGLE)  // not yet included for these instructions
#ifdef DEBURR_PRODUCT_SUM_PACKET_INL
#undef DEBURR_PRODUCT_SUM_PACKET_INL
#else
#define DEBURR_PRODUCT_SUM_PACKET_INL
#endif

#include <hwy/highway.h>

#include "raytracer/simd/product_sum_on_rays-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace deburr {
namespace HWY_NAMESPACE {

// Searches for the first root of f along each ray by halving, as RootFinder does.
class SumRootSearch {
public:
    DEBURR_INLINE SumRootSearch(const ProductSum& sum, const Rays& rays, RootCounters& counters)
        : sum_(sum, rays, counters), counters_(counters) {}

    // Which rays have a crossing, which of these go into the solid, and at which t.
    struct Found {
        M any, into;
        V t;
    };

    // First crossings of `rays` in [t0, t1], which must be finite. With `coarse`, t may be later than the crossing.
    HWY_NOINLINE Found first(M rays, V t0, V t1, V t_tolerance, bool coarse) {
        Found found{and_not(rays, rays), and_not(rays, rays), t1};
        M run = sum_.narrow(rays, t0, t1);
        if (none(run)) return found;
        Point a = sum_.evaluate(t0, run), b = sum_.evaluate(t1, run), end_a = a, end_b = b;
        int depth[max_lanes] = {};
        double waiting[max_depth][max_lanes];
        const V half = number(0.5), zero = hn::Zero(d), f_tolerance = number(RootSettings{}.f_tolerance);
        alignas(64) double next[max_lanes];
        for (;;) {
            counters_.segments += hn::CountTrue(d, run);
            const V length = b.t - a.t;
            const M open = and_not(and_(run, length > t_tolerance), at_most_one_root(a, b, f_tolerance));
            const V middle = a.t + half * length;
            const M split = and_(open, and_(middle > a.t, middle < b.t));
            const M done = and_not(run, split);
            const M crosses = and_(done, hn::Xor(a.f > zero, b.f > zero));
            found.any = or_(found.any, crosses);
            end_a = sum_.select_point(crosses, a, end_a);
            end_b = sum_.select_point(crosses, b, end_b);
            run = and_not(run, crosses);
            const M passed = and_not(done, crosses);
            a = sum_.select_point(passed, b, a);
            // The next end: the latest of the postponed ones, or the middle.
            hn::Store(select(split, middle, b.t), d, next);
            alignas(64) double end[max_lanes];
            hn::Store(b.t, d, end);
            Lanes over = 0;
            for_each_lane(bits_of(passed), [&](int k) {
                if (depth[k] == 0)
                    over |= Lanes(1) << k;
                else
                    next[k] = waiting[--depth[k]][k];
            });
            const Lanes splits = bits_of(split);
            for_each_lane(splits, [&](int k) { waiting[depth[k]++][k] = end[k]; });
            counters_.splits += count(splits);
            counters_.evaluations += count(splits);
            run = and_not(run, mask_of(over));
            if (none(run)) break;
            b = sum_.select_point(run, sum_.evaluate_uncounted(hn::Load(d, next)), b);
        }
        found.into = and_(found.any, end_b.f > zero);
        found.t = coarse ? end_b.t : root(found.any, end_a, end_b, t_tolerance);
        return found;
    }

private:
    using Point = SumOnRays::Point;
    static constexpr int max_lanes = RayPacket::size;
    // Halving stops earlier: a stretch is at most 2⁵⁵ tolerances long, and a tolerance is more than a unit in the last
    // place.
    static constexpr int max_depth = 128;

    // at_most_one_root() of bounds/root_finder, for several rays.
    DEBURR_INLINE M at_most_one_root(const Point& a, const Point& b, V f_tolerance) const {
        const SumOnRays::SlopeRange s = sum_.slopes(a, b);
        const V zero = hn::Zero(d), length = b.t - a.t;
        const M monotone = or_(s.lo >= zero, s.hi <= zero);
        const M near_zero_ends = and_(hn::Abs(a.f) <= f_tolerance, hn::Abs(b.f) <= f_tolerance);
        const M flat = and_(near_zero_ends, most(s.hi, hn::Neg(s.lo)) * length <= f_tolerance);
        const M over = a.f > zero, same = hn::Not(hn::Xor(over, b.f > zero));
        const V falling = select(over, s.lo, hn::Neg(s.hi)), rising = select(over, s.hi, hn::Neg(s.lo));
        const V fa = select(over, a.f, hn::Neg(a.f)), fb = select(over, b.f, hn::Neg(b.f));
        const V lowest = fa + falling * ((fa - fb + rising * length) / (rising - falling));
        const M away = or_(lowest > zero, and_(near_zero_ends, lowest > number(-2) * f_tolerance));
        return or_(or_(monotone, flat), and_(same, away));
    }

    // The root in [0, 1] of the stretch of the cubic with the values and slopes of f at both ends: two steps of
    // Newton's method, started at the chord's root.
    DEBURR_INLINE V cubic_root(const Point& a, const Point& b) const {
        const V zero = hn::Zero(d), two = number(2), three = number(3), length = b.t - a.t;
        const V ca = a.slope * length, cb = b.slope * length, rise = b.f - a.f;
        const V c2 = three * rise - two * ca - cb, c3 = ca + cb - two * rise;
        V x = hn::Neg(a.f) / rise;
        for (int n = 0; n < 2; ++n) {
            const V value = a.f + x * (ca + x * (c2 + x * c3)), slope = ca + x * (two * c2 + three * x * c3);
            const V next = x - value / slope;
            x = select(and_(next > zero, next < number(1)), next, x);
        }
        return x;
    }

    // RootFinder::root for several rays: the roots of `run` between a and b, where f has exactly one.
    DEBURR_INLINE V root(M run, Point a, Point b, V t_tolerance) {
        const V zero = hn::Zero(d), half = number(0.5), two = number(2);
        const M rises = b.f > zero;
        Point p = sum_.select_point(hn::Abs(a.f) < hn::Abs(b.f), a, b);
        V last = b.t - a.t, result = b.t;
        M left = and_not(run, run);  // rays for which the chord's root is taken
        constexpr int max_steps = 2000;
        for (int k = 0; k < max_steps; ++k) {
            const V length = b.t - a.t;
            left = or_(left, and_not(run, length > t_tolerance));
            run = and_(run, length > t_tolerance);
            const M at = and_(run, p.f == zero);
            result = select(at, p.t, result);
            run = and_not(run, at);
            const V step = hn::Neg(p.f) / p.slope, size = hn::Abs(step);
            V t = p.t + step;
            const V speed = hn::Abs(p.slope), h = sum_.curvature() * size;
            const M close = and_(run, and_(two * h <= speed, two * h * size <= speed * t_tolerance));
            result = select(close, clamped(t, a.t, b.t), result);
            run = and_not(run, close);
            if (none(run)) break;
            const M within = and_(t > a.t, t < b.t);
            M cut = hn::Not(within);
            if (k == 0) {
                cut = run;
                t = a.t + cubic_root(a, b) * length;
            } else {
                cut = or_(cut, size > half * last);
                t = select(cut, a.t + half * length, t);
            }
            last = select(cut, length, size);
            t = select(and_(t > a.t, t < b.t), t, a.t + half * length);
            const M stuck = and_not(run, and_(t > a.t, t < b.t));
            result = select(stuck, b.t, result);
            run = and_not(run, stuck);
            if (none(run)) break;
            p = sum_.evaluate(t, run);
            const M beyond = and_(run, select(rises, p.f, hn::Neg(p.f)) > zero);
            b = sum_.select_point(beyond, p, b);
            a = sum_.select_point(and_not(run, beyond), p, a);
        }
        left = or_(left, run);
        const V chord = select(a.f == b.f, b.t, a.t - a.f * ((b.t - a.t) / (b.f - a.f)));
        return select(left, chord, result);
    }

    SumOnRays sum_;
    RootCounters& counters_;
};

// Unit normals at t for the rays in `asked`, turned against rays that enter.
DEBURR_INLINE void sum_normals_of(const ProductSum& sum, const Rays& rays, V t, M entering, M asked, std::size_t first,
                                  double (*normal)[RayPacket::size]) {
    RootCounters none_counted;
    V n[3];
    SumOnRays(sum, rays, none_counted).gradients(t, n);
    store_against(n, rays, entering, asked, first, normal);
}

// First crossings (or any, with `Any`) of the rays in `lanes`; returns those that have one.
template <bool Any>
Lanes sum_crossings_of(const ProductSum& sum, const RayPacket& rays, Lanes lanes, const PacketSpans& spans,
                       double scale, PacketCrossings* found, RootCounters& counters) {
    Lanes crossed = 0, entering = 0;
    for (std::size_t first = 0; first < RayPacket::size; first += hn::Lanes(d)) {
        const Lanes part = part_of(lanes, first);
        if (part == 0) continue;
        const Rays some(rays, first);
        SumRootSearch search(sum, some, counters);
        const V lo = hn::Load(d, spans.from + first), hi = hn::Load(d, spans.to + first);
        const V t_tolerance = number(8 * epsilon) * (number(scale) + hn::Abs(lo));
        const auto f = search.first(mask_of(part), lo, hi, t_tolerance, Any);
        crossed |= bits_of(f.any) << first;
        if constexpr (!Any) {
            hn::Store(f.t, d, found->t + first);
            hn::Store(number(-1), d, found->plane + first);
            entering |= bits_of(f.into) << first;
        }
    }
    if constexpr (!Any) found->entering = entering;
    return crossed;
}

}  // namespace HWY_NAMESPACE
}  // namespace deburr
HWY_AFTER_NAMESPACE();

#endif
