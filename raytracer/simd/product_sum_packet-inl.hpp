// Sums of products of half-spaces along several rays at a time: bounds/product_sum_ray.cpp, where each step is
// explained, operation by operation.
//
// A ray alone leaves out the half-spaces that do not vary on its stretch. Here they stay, for other rays may need them:
// where α is beyond ±1 the density is 0 or 1 and its slope 0, exactly, so products and their slopes are the same.
#if defined(DEBURR_PRODUCT_SUM_PACKET_INL) == defined(HWY_TARGET_TOGGLE)  // not yet included for these instructions
#ifdef DEBURR_PRODUCT_SUM_PACKET_INL
#undef DEBURR_PRODUCT_SUM_PACKET_INL
#else
#define DEBURR_PRODUCT_SUM_PACKET_INL
#endif

#include <hwy/highway.h>

#include "bounds/product_sum.hpp"
#include "raytracer/simd/lanes-inl.hpp"
#include "raytracer/simd/packet_kernels.hpp"
#include "raytracer/simd/round_packet-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace deburr {
namespace HWY_NAMESPACE {

DEBURR_INLINE V exponential(V x) {
    const V two = number(2);
    return select(x < two, (two + x) / (two - x), number(infinity));
}
DEBURR_INLINE V logarithm(V x) {
    const V one = number(1);
    return select(x < one, number(2) * (x - one) / (x + one), number(0.5) * (x - one / x));
}

// The rays' view of the sum.
class SumOnRays {
public:
    DEBURR_INLINE SumOnRays(const ProductSum& sum, const Rays& rays, RootCounters& counters)
        : sum_(sum), rays_(rays), counters_(counters) {
        const double *x = sum.coefficients(0), *y = sum.coefficients(1), *z = sum.coefficients(2),
                     *base = sum.coefficients(3);
        for (int i = 0; i < sum.planes(); ++i) {
            const V nx = number(x[i]), ny = number(y[i]), nz = number(z[i]);
            a_[i] = nx * rays.origin[0] + ny * rays.origin[1] + nz * rays.origin[2] + number(base[i]);
            b_[i] = nx * rays.direction[0] + ny * rays.direction[1] + nz * rays.direction[2];
        }
        for (int i = 0; i < rounds(); ++i) round_[i].set(sum.rounds()[std::size_t(i)].coordinate, rays);
    }

    struct Found {
        M any, into;
        V t;
    };

    // First crossings of `rays` in [t0, t1], which must be finite; coarse: no matter where exactly.
    HWY_NOINLINE Found first(M rays, V t0, V t1, V t_tolerance, bool coarse) {
        Found found{and_not(rays, rays), and_not(rays, rays), t1};
        M run = narrow(rays, t0, t1);
        if (none(run)) return found;
        Point a = evaluate(t0, run), b = evaluate(t1, run), end_a = a, end_b = b;
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
            end_a = select_point(crosses, a, end_a);
            end_b = select_point(crosses, b, end_b);
            run = and_not(run, crosses);
            const M passed = and_not(done, crosses);
            a = select_point(passed, b, a);
            // The next ends: what was put off, the latest first, or the middle.
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
            b = select_point(run, evaluate_uncounted(hn::Load(d, next)), b);
        }
        found.into = and_(found.any, end_b.f > zero);
        found.t = coarse ? end_b.t : root(found.any, end_a, end_b, t_tolerance);
        return found;
    }

    // Unit gradients of the density at t; where it has none, as at an apex, the ray's direction.
    DEBURR_INLINE void gradients(V t, V* gradient) const {
        V share[ProductSum::max_planes];
        const V zero = hn::Zero(d);
        for (int i = 0; i < sum_.planes() + rounds(); ++i) share[i] = zero;
        for (const ProductSum::Term& term : sum_.terms()) {
            V before[ProductSum::max_planes], P = number(term.weight), after = number(1);
            for (std::size_t k = 0; k < term.factors.size(); ++k) {
                before[k] = P;
                P = P * profile_at(term.factors[k], t);
            }
            for (std::size_t k = term.factors.size(); k-- > 0;) {
                const int i = term.factors[k];
                const V c = clamped(alpha(i, t), number(-1), number(1)), one = number(1);
                share[i] = share[i] + before[k] * after * (number(-0.75) * (one - c) * (one + c));
                after = after * profile_at(i, t);
            }
        }
        for (int axis = 0; axis < 3; ++axis) {
            gradient[axis] = zero;
            const double* const slope = sum_.coefficients(axis);
            for (int i = 0; i < sum_.planes(); ++i) gradient[axis] = gradient[axis] + share[i] * number(slope[i]);
        }
        for (int i = 0; i < rounds(); ++i) {
            const ProductSum::Round& r = sum_.rounds()[std::size_t(i)];
            const V rate = share[sum_.planes() + i] * number(r.inverse_radius);
            V x[3], g[3];
            for (int k = 0; k < 3; ++k) x[k] = rays_.origin[k] + rays_.direction[k] * t;
            RoundOnRays::gradient(r.coordinate, x, g);
            for (int k = 0; k < 3; ++k) gradient[k] = gradient[k] + g[k] * rate;
        }
        const V length = hn::Sqrt(dot(gradient, gradient));
        for (int axis = 0; axis < 3; ++axis)
            gradient[axis] = select(length > zero, gradient[axis] / length, rays_.direction[axis]);
    }

private:
    static constexpr int max_terms = ProductSum::max_terms, max_lanes = RayPacket::size;
    // Halving ends before: a stretch is no longer than 2⁵⁵ tolerances, and a tolerance more than a unit in the last
    // place.
    static constexpr int max_depth = 128;

    // f and its slope at a point of each ray.
    struct Point {
        DEBURR_INLINE Point() {}  // one that the compiler makes is not for these instructions
        V t, f, slope;
        V value[max_terms], rate[max_terms];  // of every term
    };

    DEBURR_INLINE int terms() const { return int(sum_.terms().size()); }
    DEBURR_INLINE int rounds() const { return int(sum_.rounds().size()); }
    DEBURR_INLINE V round_alpha(int i, V u) const {
        const ProductSum::Round& r = sum_.rounds()[std::size_t(i)];
        return (u - number(r.offset)) * number(r.inverse_radius);
    }
    DEBURR_INLINE V alpha(int i, V t) const {
        const int round = i - sum_.planes();
        return round < 0 ? a_[i] + b_[i] * t : round_alpha(round, round_[round].at(t));
    }
    DEBURR_INLINE V profile_at(int i, V t) const {
        const V c = clamped(alpha(i, t), number(-1), number(1)), u = number(1) - c;
        return u * u * (number(2) + c) * number(0.25);
    }

    DEBURR_INLINE Point select_point(M m, const Point& a, const Point& b) const {
        Point p;
        p.t = select(m, a.t, b.t);
        p.f = select(m, a.f, b.f);
        p.slope = select(m, a.slope, b.slope);
        for (int k = 0; k < terms(); ++k) {
            p.value[k] = select(m, a.value[k], b.value[k]);
            p.rate[k] = select(m, a.rate[k], b.rate[k]);
        }
        return p;
    }

    // Those of `rays` that have anything left.
    DEBURR_INLINE M narrow(M rays, V& t0, V& t1) {
        const V zero = hn::Zero(d), never = number(-infinity);
        V begin = sum_.anywhere() ? t0 : number(infinity), end = sum_.anywhere() ? t1 : never;
        for (const ProductSum::Term& term : sum_.terms()) {
            if (term.reach == infinity) continue;
            V lo = t0, hi = t1;
            for (const int i : term.factors) {
                if (i >= sum_.planes()) {
                    const ProductSum::Round& r = sum_.rounds()[std::size_t(i - sum_.planes())];
                    round_[i - sum_.planes()].clip(number(r.offset + term.reach / r.inverse_radius), lo, hi);
                    continue;
                }
                const V room = number(term.reach) - a_[i], at = room / b_[i];
                hi = select(b_[i] > zero, least(hi, at), hi);
                lo = select(b_[i] < zero, most(lo, at), lo);
                hi = select(and_(b_[i] == zero, room < zero), never, hi);
            }
            const M reaches = lo <= hi;
            begin = select(reaches, least(begin, lo), begin);
            end = select(reaches, most(end, hi), end);
        }
        t0 = begin;
        t1 = end;
        const V one = number(1), minus_one = number(-1);
        M is_one[ProductSum::max_planes], is_zero[ProductSum::max_planes];
        V steepness[ProductSum::max_planes], bend[ProductSum::max_planes];  // |α′| and |α″| at most
        for (int i = 0; i < sum_.planes(); ++i) {
            const V from = alpha(i, t0), to = alpha(i, t1);
            is_one[i] = and_(from <= minus_one, to <= minus_one);
            is_zero[i] = and_(from >= one, to >= one);
            steepness[i] = hn::Abs(b_[i]);
            bend[i] = zero;
        }
        for (int i = 0; i < rounds(); ++i) {
            const int factor = sum_.planes() + i;
            const auto u = round_[i].range(t0, t1);
            const V inverse_radius = number(sum_.rounds()[std::size_t(i)].inverse_radius);
            is_one[factor] = round_is_one_[i] = round_alpha(i, u.hi) <= minus_one;
            is_zero[factor] = and_not(round_alpha(i, u.lo) >= one, is_one[factor]);
            steepness[factor] = round_[i].max_slope(t0, t1) * inverse_radius;
            bend[factor] = round_[i].max_curvature(t0, t1) * inverse_radius;
        }
        constant_ = number(sum_.constant() - 0.5);
        curvature_ = zero;
        M any = and_not(rays, rays);
        for (int k = 0; k < terms(); ++k) {
            const ProductSum::Term& term = sum_.terms()[std::size_t(k)];
            M vanishes = and_not(rays, rays), varies = vanishes;
            V rates = zero, squares = zero, bends = zero;
            for (const int i : term.factors) {
                vanishes = or_(vanishes, is_zero[i]);
                const M fixed = or_(is_one[i], is_zero[i]);
                varies = or_(varies, hn::Not(fixed));
                rates = rates + select(fixed, zero, steepness[i]);
                squares = squares + select(fixed, zero, steepness[i] * steepness[i]);
                bends = bends + select(fixed, zero, bend[i]);
            }
            active_[k] = and_not(varies, vanishes);
            const M is_constant = and_not(hn::Not(varies), vanishes);
            constant_ = select(is_constant, constant_ + number(term.weight), constant_);
            const V bound = number(std::abs(term.weight)) *
                            (number(1.5) * squares + number(0.5625) * (rates * rates - squares) + number(0.75) * bends);
            curvature_ = select(active_[k], curvature_ + bound, curvature_);
            any = or_(any, active_[k]);
        }
        return and_(and_(rays, any), t0 <= t1);
    }

    DEBURR_INLINE Point evaluate(V t, M asked) {
        counters_.evaluations += hn::CountTrue(d, asked);
        return evaluate_uncounted(t);
    }
    DEBURR_INLINE Point evaluate_uncounted(V t) const {
        const V one = number(1), zero = hn::Zero(d);
        V F[ProductSum::max_planes], slope[ProductSum::max_planes];
        for (int i = 0; i < sum_.planes(); ++i) {
            const V c = hn::Max(hn::Min(alpha(i, t), one), hn::Neg(one)), u = one - c;
            F[i] = u * u * (number(2) + c) * number(0.25);
            slope[i] = number(-0.75) * u * (one + c) * b_[i];
        }
        for (int i = 0; i < rounds(); ++i) {
            const int factor = sum_.planes() + i;
            const V rate = round_[i].slope(t) * number(sum_.rounds()[std::size_t(i)].inverse_radius);
            const V c = hn::Max(hn::Min(alpha(factor, t), one), hn::Neg(one)), u = one - c;
            // Rounding might find it less than 1 between ends where it is 1.
            F[factor] = select(round_is_one_[i], one, u * u * (number(2) + c) * number(0.25));
            slope[factor] = select(round_is_one_[i], zero, number(-0.75) * u * (one + c) * rate);
        }
        Point p;
        p.t = t;
        p.f = constant_;
        p.slope = zero;
        for (int k = 0; k < terms(); ++k) {
            const ProductSum::Term& term = sum_.terms()[std::size_t(k)];
            V P = one, rate = zero;
            for (const int i : term.factors) {
                rate = rate * F[i] + P * slope[i];
                P = P * F[i];
            }
            p.value[k] = P;
            p.rate[k] = rate;
            const V weight = number(term.weight);
            p.f = select(active_[k], p.f + weight * P, p.f);
            p.slope = select(active_[k], p.slope + weight * rate, p.slope);
        }
        p.f = select(hn::Abs(p.f) <= number(RootFinder::rounding), zero, p.f);
        return p;
    }

    struct SlopeRange {
        V lo, hi;
    };

    DEBURR_INLINE SlopeRange slopes(const Point& a, const Point& b) const {
        constexpr double min_product = 1e-200;
        const V length = b.t - a.t, zero = hn::Zero(d), one = number(1);
        SlopeRange sum{zero, zero};
        for (int k = 0; k < terms(); ++k) {
            const V Pa = a.value[k], Pb = b.value[k];
            const M positive = and_(Pa > number(min_product), Pb > number(min_product));
            const V la = a.rate[k] / Pa, lb = b.rate[k] / Pb;
            const V lower = least(Pa, Pb);
            V upper = most(Pa, Pb);
            const M hill = and_(and_(la > zero, lb < zero), positive);
            if (!none(hill)) {
                const V meet = (logarithm(Pb / Pa) - lb * length) / (la - lb);
                upper = select(hill, least(one, Pa * exponential(la * clamped(meet, zero, length))), upper);
            }
            SlopeRange r{select(lb < zero, upper, lower) * lb, select(la > zero, upper, lower) * la};
            const M near_zero = and_not(active_[k], positive);
            if (!none(near_zero)) {
                const SlopeRange other = slopes_near_zero(k, a, b);
                r.lo = select(near_zero, other.lo, r.lo);
                r.hi = select(near_zero, other.hi, r.hi);
            }
            const double weight = sum_.terms()[std::size_t(k)].weight;
            const V w = number(weight);
            sum.lo = select(active_[k], sum.lo + w * (weight > 0 ? r.lo : r.hi), sum.lo);
            sum.hi = select(active_[k], sum.hi + w * (weight > 0 ? r.hi : r.lo), sum.hi);
        }
        return sum;
    }

    // As half_space_bounds() and product_bounds() say, but for the second derivatives.
    DEBURR_INLINE SlopeRange slopes_near_zero(int k, const Point& a, const Point& b) const {
        const V one = number(1), zero = hn::Zero(d);
        V M_all = one, L_all = zero;
        for (const int i : sum_.terms()[std::size_t(k)].factors) {
            const int round = i - sum_.planes();
            V a0, a1, rate;
            M is_one = hn::Xor(active_[k], active_[k]);
            if (round < 0) {
                a0 = alpha(i, a.t);
                a1 = alpha(i, b.t);
                rate = hn::Abs(b_[i]);
            } else {
                const auto range = round_[round].range(a.t, b.t);
                a0 = round_alpha(round, range.lo);
                a1 = round_alpha(round, range.hi);
                rate = round_[round].max_slope(a.t, b.t) * number(sum_.rounds()[std::size_t(round)].inverse_radius);
                is_one = round_is_one_[round];
            }
            const V lo = select(a0 < a1, a0, a1), hi = select(a0 < a1, a1, a0);
            const V nearest = select(lo > zero, lo, select(hi < zero, hn::Neg(hi), zero));
            const V c = clamped(lo, number(-1), one);
            V M_i = (one - c) * (one - c) * (number(2) + c) * number(0.25);
            V L_i = number(0.75) * (one - nearest * nearest) * rate;
            const M inside = or_(is_one, hi <= number(-1)), outside = and_not(lo >= one, is_one);
            M_i = select(outside, zero, select(inside, one, M_i));
            L_i = select(or_(outside, inside), zero, L_i);
            L_all = M_all * L_i + M_i * L_all;
            M_all = M_all * M_i;
        }
        return {select(b.rate[k] > zero, zero, hn::Neg(L_all)), select(a.rate[k] < zero, zero, L_all)};
    }

    DEBURR_INLINE M at_most_one_root(const Point& a, const Point& b, V f_tolerance) const {
        const SlopeRange s = slopes(a, b);
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

    DEBURR_INLINE V root(M run, Point a, Point b, V t_tolerance) {
        const V zero = hn::Zero(d), half = number(0.5), two = number(2), three = number(3);
        const M rises = b.f > zero;
        Point p = select_point(hn::Abs(a.f) < hn::Abs(b.f), a, b);
        V last = b.t - a.t, result = b.t;
        M left = and_not(run, run);  // to the chord's root
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
            const V speed = hn::Abs(p.slope), h = curvature_ * size;
            const M close = and_(run, and_(two * h <= speed, two * h * size <= speed * t_tolerance));
            result = select(close, clamped(t, a.t, b.t), result);
            run = and_not(run, close);
            if (none(run)) break;
            const M within = and_(t > a.t, t < b.t);
            M cut = hn::Not(within);
            if (k == 0) {
                cut = run;
                const V ca = a.slope * length, cb = b.slope * length, rise = b.f - a.f;
                const V c2 = three * rise - two * ca - cb, c3 = ca + cb - two * rise;
                V x = hn::Neg(a.f) / rise;
                for (int n = 0; n < 2; ++n) {
                    const V value = a.f + x * (ca + x * (c2 + x * c3)), slope = ca + x * (two * c2 + three * x * c3);
                    const V next = x - value / slope;
                    x = select(and_(next > zero, next < number(1)), next, x);
                }
                t = a.t + x * length;
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
            p = evaluate(t, run);
            const M beyond = and_(run, select(rises, p.f, hn::Neg(p.f)) > zero);
            b = select_point(beyond, p, b);
            a = select_point(and_not(run, beyond), p, a);
        }
        left = or_(left, run);
        const V chord = select(a.f == b.f, b.t, a.t - a.f * ((b.t - a.t) / (b.f - a.f)));
        return select(left, chord, result);
    }

    const ProductSum& sum_;
    const Rays& rays_;
    RootCounters& counters_;
    RoundOnRays round_[ProductSum::max_rounds];
    M round_is_one_[ProductSum::max_rounds];
    V a_[ProductSum::max_planes], b_[ProductSum::max_planes];  // every α = a + b·t
    M active_[max_terms];                                      // where the term varies and does not vanish
    V constant_, curvature_;                                   // the rest of f; |f″| at most
};

// Unit normals of `asked` at t, against rays that enter.
DEBURR_INLINE void sum_normals_of(const ProductSum& sum, const Rays& rays, V t, M entering, M asked, std::size_t first,
                                  double (*normal)[RayPacket::size]) {
    RootCounters none_counted;
    V n[3];
    SumOnRays(sum, rays, none_counted).gradients(t, n);
    store_against(n, rays, entering, asked, first, normal);
}

template <bool Any>
Lanes sum_crossings_of(const ProductSum& sum, const RayPacket& rays, Lanes lanes, const PacketSpans& spans,
                       double scale, PacketCrossings* found, RootCounters& counters) {
    Lanes crossed = 0, entering = 0;
    for (std::size_t first = 0; first < RayPacket::size; first += hn::Lanes(d)) {
        const Lanes part = part_of(lanes, first);
        if (part == 0) continue;
        const Rays some(rays, first);
        SumOnRays on_rays(sum, some, counters);
        const V lo = hn::Load(d, spans.from + first), hi = hn::Load(d, spans.to + first);
        const V t_tolerance = number(8 * epsilon) * (number(scale) + hn::Abs(lo));
        const auto f = on_rays.first(mask_of(part), lo, hi, t_tolerance, Any);
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
