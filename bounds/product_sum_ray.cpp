#include <algorithm>
#include <cmath>

#include "bounds/clamped_alpha.hpp"
#include "bounds/product_sum.hpp"

namespace deburr {

namespace {

DoublePair pair_at(const double* aligned) { return *reinterpret_cast<const DoublePair*>(aligned); }
void set_pair(double* aligned, DoublePair x) { *reinterpret_cast<DoublePair*>(aligned) = x; }

}  // namespace

void ProductSumRay::set(const ProductSum& sum, const Vec3& origin, const Vec3& direction) {
    sum_ = &sum;
    const int n = sum.even_planes();
    const double *x = sum.coefficients(0), *y = sum.coefficients(1), *z = sum.coefficients(2),
                 *base = sum.coefficients(3);
    for (int i = 0; i < n; ++i) {
        a_[i] = x[i] * origin.x + y[i] * origin.y + z[i] * origin.z + base[i];
        b_[i] = x[i] * direction.x + y[i] * direction.y + z[i] * direction.z;
    }
    if (sum.rounds().empty()) return;
    origin_ = origin;
    direction_ = direction;
    for (std::size_t i = 0; i < sum.rounds().size(); ++i) on_ray_[i].set(sum.rounds()[i].coordinate, origin, direction);
}

// Density of every plane and round part at t, and its slope by α.
void ProductSumRay::densities(double t, double* F, double* slope) const {
    const int planes = sum_->planes(), rounds = int(sum_->rounds().size());
    for (int i = 0; i < planes; i += 2) {  // an odd last plane's partner is overwritten below
        const DoublePair c = clamped_alpha(pair_at(a_ + i) + pair_at(b_ + i) * t), u = 1 - c;
        set_pair(F + i, u * u * (2 + c) * 0.25);
        set_pair(slope + i, -0.75 * u * (1 + c));
    }
    for (int i = 0; i < rounds; ++i) {
        const double c = clamped_alpha(round_alpha(i, t)), u = 1 - c;
        F[planes + i] = u * u * (2 + c) * 0.25;
        slope[planes + i] = -0.75 * u * (1 + c);
    }
}

bool ProductSumRay::inside(double t) const {
    alignas(16) double F[max_planes + 1], slope[max_planes + 1];
    densities(t, F, slope);
    double rho = sum_->constant();
    for (const ProductSum::Term& term : sum_->terms()) {
        double P = term.weight;
        for (const int i : term.factors) P *= F[i];
        rho += P;
    }
    return rho > 0.5;
}

Vec3 ProductSumRay::gradient(double t) const {
    alignas(16) double F[max_planes + 1], slope[max_planes + 1];
    densities(t, F, slope);
    double share[max_planes] = {};  // dρ/dα of every factor
    for (const ProductSum::Term& term : sum_->terms()) {
        double before[max_planes];  // product of the factors before factor k
        double P = term.weight;
        for (std::size_t k = 0; k < term.factors.size(); ++k) {
            before[k] = P;
            P *= F[term.factors[k]];
        }
        double after = 1;
        for (std::size_t k = term.factors.size(); k-- > 0;) {
            const int i = term.factors[k];
            share[i] += before[k] * after * slope[i];
            after *= F[i];
        }
    }
    Vec3 sum(0.0);
    for (int i = 0; i < sum_->planes(); ++i)
        sum += share[i] * Vec3(sum_->coefficients(0)[i], sum_->coefficients(1)[i], sum_->coefficients(2)[i]);
    for (std::size_t i = 0; i < sum_->rounds().size(); ++i) {
        const ProductSum::Round& r = sum_->rounds()[i];
        const double rate = share[std::size_t(sum_->planes()) + i] * r.inverse_radius;
        sum += r.coordinate.gradient(origin_ + direction_ * t) * rate;
    }
    return sum;
}

// Cuts [lo, hi] down to where α ≤ reach for all factors of the term.
void ProductSumRay::reach(const ProductSum::Term& term, double& lo, double& hi) const {
    for (const int i : term.factors) {
        if (i < sum_->planes()) {
            const double room = term.reach - a_[i];
            if (b_[i] > 0)
                hi = std::min(hi, room / b_[i]);
            else if (b_[i] < 0)
                lo = std::max(lo, room / b_[i]);
            else if (room < 0)
                hi = -infinity;
            continue;
        }
        const RoundOnRay& on_ray = on_ray_[i - sum_->planes()];
        const ProductSum::Round& r = sum_->rounds()[std::size_t(i - sum_->planes())];
        const double level = r.offset + term.reach / r.inverse_radius;
        const RoundOnRay::Crossings c = on_ray.crossings(level);
        if (c.count == 2) {
            lo = std::max(lo, c.t[0]);
            hi = std::min(hi, c.t[1]);
        } else if (c.count == 1) {
            if (on_ray.slope(c.t[0]) < 0)
                lo = std::max(lo, c.t[0]);
            else
                hi = std::min(hi, c.t[0]);
        } else if (!(on_ray.at(lo) <= level)) {
            hi = -infinity;
        }
    }
}

// A ray parameter beyond which no factor varies.
double ProductSumRay::last_change(double t0) const {
    double t = t0;
    for (int i = 0; i < sum_->planes(); ++i)
        if (b_[i] != 0) t = std::max(t, (std::abs(a_[i]) + 2) / std::abs(b_[i]));
    for (std::size_t i = 0; i < sum_->rounds().size(); ++i) {
        const ProductSum::Round& r = sum_->rounds()[i];
        for (const double side : {-1.0, 1.0}) {
            const RoundOnRay::Crossings c = on_ray_[i].crossings(r.offset + side / r.inverse_radius);
            for (int k = 0; k < c.count; ++k) t = std::max(t, c.t[k]);
        }
    }
    return std::min(t, 1e300);
}

bool ProductSumRay::narrow(double& t0, double& t1) {
    // To the hull of where terms with a finite reach can supply the surface.
    double begin = sum_->anywhere() ? t0 : infinity, end = sum_->anywhere() ? t1 : -infinity;
    for (const ProductSum::Term& term : sum_->terms()) {
        if (term.reach == infinity) continue;
        double lo = t0, hi = t1;
        reach(term, lo, hi);
        if (lo > hi) continue;
        begin = std::min(begin, lo);
        end = std::max(end, hi);
    }
    t0 = begin;
    t1 = end;
    if (!(t0 <= t1)) return false;
    if (t1 == infinity) t1 = last_change(t0);
    return choose_varying(t0, t1);
}

bool ProductSumRay::choose_varying(double t0, double t1) {
    constexpr int one = -1, zero = -2;
    int new_index[max_planes];
    double rate[max_planes], bend[max_planes];  // bounds of |α′| and |α″|
    varying_ = 0;
    const int planes = sum_->planes(), rounds = int(sum_->rounds().size());
    for (int i = 0; i < planes; ++i) {
        const double from = a_[i] + b_[i] * t0, to = a_[i] + b_[i] * t1;
        if (from <= -1 && to <= -1) {
            new_index[i] = one;
        } else if (from >= 1 && to >= 1) {
            new_index[i] = zero;
        } else {
            varying_a_[varying_] = a_[i];
            varying_b_[varying_] = b_[i];
            new_index[i] = varying_++;
        }
        rate[i] = std::abs(b_[i]);
        bend[i] = 0;
    }
    varying_a_[varying_] = varying_b_[varying_] = 0;  // evaluated along with the last plane if their number is odd
    for (int i = 0; i < rounds; ++i) {
        const ProductSum::Round& r = sum_->rounds()[std::size_t(i)];
        const Range u = on_ray_[i].range(t0, t1);
        const double lo = (u.lo - r.offset) * r.inverse_radius, hi = (u.hi - r.offset) * r.inverse_radius;
        new_index[planes + i] = hi <= -1 ? one : lo >= 1 ? zero : i;
        rate[planes + i] = on_ray_[i].max_slope(t0, t1) * r.inverse_radius;
        bend[planes + i] = on_ray_[i].max_curvature(t0, t1) * r.inverse_radius;
    }
    terms_ = 0;
    constant_ = sum_->constant() - 0.5;
    curvature_ = 0;
    for (const ProductSum::Term& term : sum_->terms()) {
        Term& to = term_[terms_];
        to.weight = term.weight;
        to.count = to.rounds = 0;
        bool vanishes = false;
        double rates = 0, squares = 0, bends = 0;
        for (const int i : term.factors) {
            vanishes |= new_index[i] == zero;
            if (new_index[i] < 0) continue;
            to.factors[to.count + to.rounds] = std::uint8_t(new_index[i]);
            ++(i < planes ? to.count : to.rounds);
            rates += rate[i];
            squares += rate[i] * rate[i];
            bends += bend[i];
        }
        if (vanishes) continue;
        if (to.count + to.rounds == 0) {
            constant_ += term.weight;
            continue;
        }
        // |F′| ≤ ¾ |α′|, |F″| ≤ 3/2 α′² + ¾ |α″| for each factor.
        curvature_ += std::abs(term.weight) * (1.5 * squares + 0.5625 * (rates * rates - squares) + 0.75 * bends);
        ++terms_;
    }
    return terms_ > 0;
}

void ProductSumRay::evaluate(double t, RootCounters& counters, Point& p) const {
    ++counters.evaluations;
    alignas(16) double F[max_planes + 1], slope[max_planes + 1];
    for (int i = 0; i < varying_; i += 2) {
        const DoublePair a = pair_at(varying_a_ + i), b = pair_at(varying_b_ + i);
        const DoublePair c = clamped_alpha(a + b * t), u = 1 - c;
        set_pair(F + i, u * u * (2 + c) * 0.25);
        set_pair(slope + i, -0.75 * u * (1 + c) * b);
    }
    double round_F[max_rounds], round_slope[max_rounds];
    for (std::size_t i = 0; i < sum_->rounds().size(); ++i) {
        const double here = round_alpha(int(i), t), rate = on_ray_[i].slope(t) * sum_->rounds()[i].inverse_radius;
        const double c = clamped_alpha(here), u = 1 - c;
        round_F[i] = u * u * (2 + c) * 0.25;
        round_slope[i] = -0.75 * u * (1 + c) * rate;
    }
    p.t = t;
    p.f = constant_;
    p.slope = 0;
    for (int k = 0; k < terms_; ++k) {
        const Term& term = term_[k];
        double P = 1, rate = 0;
        for (int j = 0; j < term.count; ++j) {
            const int i = term.factors[j];
            rate = rate * F[i] + P * slope[i];
            P *= F[i];
        }
        for (int j = term.count; j < term.count + term.rounds; ++j) {
            const int i = term.factors[j];
            rate = rate * round_F[i] + P * round_slope[i];
            P *= round_F[i];
        }
        p.value[k] = P;
        p.rate[k] = rate;
        p.f += term.weight * P;
        p.slope += term.weight * rate;
    }
    if (std::abs(p.f) <= RootFinder::rounding) p.f = 0;
}

namespace {

// Products below this count as 0, because the slope of their logarithm may overflow.
constexpr double min_product = 1e-200;

// Upper bounds of eˣ for x ≥ 0 and of log x, exact to second order at 0 and 1. The C library's functions need not
// return the same bits everywhere.
double exponential(double x) { return x < 2 ? (2 + x) / (2 - x) : infinity; }
double logarithm(double x) { return x < 1 ? 2 * (x - 1) / (x + 1) : 0.5 * (x - 1 / x); }

}  // namespace

ProductSumRay::SlopeRange ProductSumRay::slopes(const Point& a, const Point& b) const {
    const double length = b.t - a.t;
    SlopeRange sum{0, 0};
    for (int k = 0; k < terms_; ++k) {
        const double Pa = a.value[k], Pb = b.value[k];
        SlopeRange r;
        if (Pa > min_product && Pb > min_product) {
            // log P is concave: its slope falls from la to lb.
            const double la = a.rate[k] / Pa, lb = b.rate[k] / Pb;
            const double least = std::min(Pa, Pb);
            double most = std::max(Pa, Pb);
            if (la > 0 && lb < 0) {
                // P is no greater than where the tangents of log P at the two ends meet.
                const double meet = (logarithm(Pb / Pa) - lb * length) / (la - lb);
                most = std::min(1.0, Pa * exponential(la * std::clamp(meet, 0.0, length)));
            }
            r = {lb < 0 ? most * lb : least * lb, la > 0 ? most * la : least * la};
        } else {
            r = slopes_near_zero(k, a, b);
        }
        const double w = term_[k].weight;
        sum.lo += w * (w > 0 ? r.lo : r.hi);
        sum.hi += w * (w > 0 ? r.hi : r.lo);
    }
    return sum;
}

// Range of P′ where one end lies (nearly) outside of the stretch in which every factor is above 0.
ProductSumRay::SlopeRange ProductSumRay::slopes_near_zero(int k, const Point& a, const Point& b) const {
    RayBounds all{1, 0, 0};
    for (int j = 0; j < term_[k].count; ++j) {
        const int i = term_[k].factors[j];
        const double rate = varying_b_[i];
        all = product_bounds(all,
                             half_space_bounds(varying_a_[i] + rate * a.t, varying_a_[i] + rate * b.t, std::abs(rate)));
    }
    for (int j = term_[k].count; j < term_[k].count + term_[k].rounds; ++j) {
        const int i = term_[k].factors[j];
        const ProductSum::Round& r = sum_->rounds()[std::size_t(i)];
        const Range u = on_ray_[i].range(a.t, b.t);
        all = product_bounds(
            all, half_space_bounds((u.lo - r.offset) * r.inverse_radius, (u.hi - r.offset) * r.inverse_radius,
                                   on_ray_[i].max_slope(a.t, b.t) * r.inverse_radius));
    }
    // P is log-concave: if it rises at the end it has risen throughout, and if it falls at the start it falls
    // throughout.
    return {b.rate[k] > 0 ? 0 : -all.L, a.rate[k] < 0 ? 0 : all.L};
}

bool at_most_one_root(const ProductSumRay::Point& a, const ProductSumRay::Point& b, ProductSumRay::SlopeRange slopes,
                      double f_tolerance) {
    if (slopes.lo >= 0 || slopes.hi <= 0) return true;
    const double length = b.t - a.t;
    const bool near_zero_ends = std::abs(a.f) <= f_tolerance && std::abs(b.f) <= f_tolerance;
    if (near_zero_ends && std::max(slopes.hi, -slopes.lo) * length <= f_tolerance) return true;
    if ((a.f > 0) != (b.f > 0)) return false;
    // The least |f| if f falls from both ends as fast as it can.
    const double sign = a.f > 0 ? 1 : -1;
    const double falling = a.f > 0 ? slopes.lo : -slopes.hi, rising = a.f > 0 ? slopes.hi : -slopes.lo;
    const double fa = sign * a.f, fb = sign * b.f;
    const double least = fa + falling * ((fa - fb + rising * length) / (rising - falling));
    return least > 0 || (near_zero_ends && least > -2 * f_tolerance);
}

// The root between two ends of opposite sign, by Newton's method kept within the bracket. With |f″| ≤ G and step =
// f/f′, h = G |step/f′| ≤ ½ leaves an error of 2h |step| at most [Kantorovich].
double ProductSumRay::root(const Point& from, const Point& until, double t_tolerance, RootCounters& counters) const {
    struct End {
        double t, f, slope;
    };
    const auto end = [](const Point& at) { return End{at.t, at.f, at.slope}; };
    End a = end(from), b = end(until);
    Point at;
    const double sign = b.f > 0 ? 1 : -1;  // f·sign rises through 0 from a to b
    End p = std::abs(a.f) < std::abs(b.f) ? a : b;
    double last = b.t - a.t;         // length of the last step
    constexpr int max_steps = 2000;  // halving alone exhausts a double's range before
    for (int k = 0; k < max_steps && b.t - a.t > t_tolerance; ++k) {
        if (p.f == 0) return p.t;
        const double step = -p.f / p.slope;
        double t = p.t + step;
        const double speed = std::abs(p.slope), h = curvature_ * std::abs(step);
        if (2 * h <= speed && 2 * h * std::abs(step) <= speed * t_tolerance) return std::clamp(t, a.t, b.t);
        if (k == 0 || !(t > a.t && t < b.t) || std::abs(step) > 0.5 * last) {
            const double length = b.t - a.t;
            if (k == 0) {
                // First the root of the cubic through both ends, by two Newton steps from the chord's root.
                const double ca = a.slope * length, cb = b.slope * length, rise = b.f - a.f;
                const double c2 = 3 * rise - 2 * ca - cb, c3 = ca + cb - 2 * rise;
                double x = -a.f / rise;
                for (int n = 0; n < 2; ++n) {
                    const double value = a.f + x * (ca + x * (c2 + x * c3)), d = ca + x * (2 * c2 + 3 * x * c3);
                    const double next = x - value / d;
                    if (next > 0 && next < 1) x = next;
                }
                t = a.t + x * length;
            } else {
                t = a.t + 0.5 * length;
            }
            last = length;
            if (!(t > a.t && t < b.t)) t = a.t + 0.5 * length;
            if (!(t > a.t && t < b.t)) return b.t;
        } else {
            last = std::abs(step);
        }
        evaluate(t, counters, at);
        p = end(at);
        (p.f * sign > 0 ? b : a) = p;
    }
    return a.f == b.f ? b.t : a.t - a.f * ((b.t - a.t) / (b.f - a.f));
}

}  // namespace deburr
