// A sum of products of half-spaces and round parts along several rays at a time: its value, slope and bounds, by the
// operations of bounds/product_sum_ray.cpp, where each step is explained, in the same order.
//
// A single ray leaves out the half-spaces that do not vary on its stretch. Here they stay, since other rays may need
// them: where α is beyond ±1 a density is 0 or 1 and its slope 0, exactly, so products and their slopes are the same.
#if defined(DEBURR_PRODUCT_SUM_ON_RAYS_INL) == defined(HWY_TARGET_TOGGLE)  // not yet included for these instructions
#ifdef DEBURR_PRODUCT_SUM_ON_RAYS_INL
#undef DEBURR_PRODUCT_SUM_ON_RAYS_INL
#else
#define DEBURR_PRODUCT_SUM_ON_RAYS_INL
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

// f = ρ − ½ of a sum along the rays. Call narrow() first: it sets what the other functions use.
class SumOnRays {
public:
    static constexpr int max_terms = ProductSum::max_terms;

    // The value of f and its derivative at a point of each ray.
    struct Point {
        DEBURR_INLINE Point() {}  // not defaulted: the compiler's would lack this instruction set
        V t, f, slope;
        V value[max_terms], rate[max_terms];  // P of each term, and its derivative
    };

    // A lower and an upper bound of f′.
    struct SlopeRange {
        V lo, hi;
    };

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

    // Moves t0 and t1 to a stretch outside of which every term is 0, as far as that is known. Returns the rays whose f
    // varies there. All other functions may be called within that stretch only.
    DEBURR_INLINE M narrow(M rays, V& t0, V& t1) {
        clip_to_terms(t0, t1);
        const M any = bound_terms(bounds_of_factors(t0, t1), and_not(rays, rays));
        return and_(and_(rays, any), t0 <= t1);
    }

    // f at t. Evaluations are counted for the rays in `asked`.
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
            // Rounding might make it less than 1 between two ends where it is 1.
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

    // Ray by ray: a where m is set, else b.
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

    // Bounds of f′ between two points of each ray.
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

    // Upper bound of |f″| on the stretch that narrow() left.
    DEBURR_INLINE V curvature() const { return curvature_; }

    // Unit gradients of ρ at t; the ray's direction where there is none, as at an apex.
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

    // For each factor F(α): whether it is 1 or 0 on a whole stretch, and upper bounds of |α′| and |α″| there.
    struct FactorBounds {
        DEBURR_INLINE FactorBounds() {}  // not defaulted: the compiler's would lack this instruction set
        M is_one[ProductSum::max_planes], is_zero[ProductSum::max_planes];
        V steepness[ProductSum::max_planes], bend[ProductSum::max_planes];
    };

    DEBURR_INLINE void clip_to_terms(V& t0, V& t1) {
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
    }

    DEBURR_INLINE FactorBounds bounds_of_factors(V t0, V t1) {
        FactorBounds f;
        const V one = number(1), minus_one = number(-1), zero = hn::Zero(d);
        for (int i = 0; i < sum_.planes(); ++i) {
            const V from = alpha(i, t0), to = alpha(i, t1);
            f.is_one[i] = and_(from <= minus_one, to <= minus_one);
            f.is_zero[i] = and_(from >= one, to >= one);
            f.steepness[i] = hn::Abs(b_[i]);
            f.bend[i] = zero;
        }
        for (int i = 0; i < rounds(); ++i) {
            const int factor = sum_.planes() + i;
            const auto u = round_[i].range(t0, t1);
            const V inverse_radius = number(sum_.rounds()[std::size_t(i)].inverse_radius);
            f.is_one[factor] = round_is_one_[i] = round_alpha(i, u.hi) <= minus_one;
            f.is_zero[factor] = and_not(round_alpha(i, u.lo) >= one, f.is_one[factor]);
            f.steepness[factor] = round_[i].max_slope(t0, t1) * inverse_radius;
            f.bend[factor] = round_[i].max_curvature(t0, t1) * inverse_radius;
        }
        return f;
    }

    // Finds the terms that vary, the sum of the constant ones, and an upper bound of |f″| of the others. Returns the
    // rays that have a term that varies.
    DEBURR_INLINE M bound_terms(const FactorBounds& f, M never) {
        const V zero = hn::Zero(d);
        constant_ = number(sum_.constant() - 0.5);
        curvature_ = zero;
        M any = never;
        for (int k = 0; k < terms(); ++k) {
            const ProductSum::Term& term = sum_.terms()[std::size_t(k)];
            M vanishes = never, varies = never;
            V rates = zero, squares = zero, bends = zero;
            for (const int i : term.factors) {
                vanishes = or_(vanishes, f.is_zero[i]);
                const M fixed = or_(f.is_one[i], f.is_zero[i]);
                varies = or_(varies, hn::Not(fixed));
                rates = rates + select(fixed, zero, f.steepness[i]);
                squares = squares + select(fixed, zero, f.steepness[i] * f.steepness[i]);
                bends = bends + select(fixed, zero, f.bend[i]);
            }
            active_[k] = and_not(varies, vanishes);
            const M is_constant = and_not(hn::Not(varies), vanishes);
            constant_ = select(is_constant, constant_ + number(term.weight), constant_);
            const V bound = number(std::abs(term.weight)) *
                            (number(1.5) * squares + number(0.5625) * (rates * rates - squares) + number(0.75) * bends);
            curvature_ = select(active_[k], curvature_ + bound, curvature_);
            any = or_(any, active_[k]);
        }
        return any;
    }

    // slopes() of term k where a value is too close to 0 to be divided by: the bounds of half_space_bounds() and
    // product_bounds(), without second derivatives.
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

    const ProductSum& sum_;
    const Rays& rays_;
    RootCounters& counters_;
    RoundOnRays round_[ProductSum::max_rounds];
    M round_is_one_[ProductSum::max_rounds];
    V a_[ProductSum::max_planes], b_[ProductSum::max_planes];  // α = a + b·t of every half-space
    M active_[max_terms];                                      // rays for which the term varies and does not vanish
    V constant_, curvature_;                                   // f − Σ of the varying terms; upper bound of |f″|
};

}  // namespace HWY_NAMESPACE
}  // namespace deburr
HWY_AFTER_NAMESPACE();

#endif
