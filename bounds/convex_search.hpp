// Crossings of ρ = ½ on a ray along which log ρ, or log(1 − ρ), is concave, by Newton's method from outside
// [docs/design.md, Roots on a ray].
#pragma once
#include <algorithm>
#include <cstdint>

#include "bounds/convex_density.hpp"
#include "bounds/root_finder.hpp"

namespace deburr {

/// The search, with C the stretch of the ray where the product P of all factors exceeds ½. The class is a base of
/// `Factors` (CRTP), whose constructor clips C to where each factor may exceed ½, sets `rates_`, and which defines
///
///     Point at(double t) const                    P of the soft factors at t, and its slope
///     bool is_alone(int factor, double t) const   whether all other factors are 1 at t, where this soft factor is ½
///     double end_of_change(double end) const      a parameter ≥ end beyond which no soft factor varies
///     int soft() const                            number of soft factors; sharp ones are numbered from there on
template <class Factors>
class ConvexSearch {
public:
    ConvexSearch(bool complement, std::uint64_t& evaluations)
        : evaluations_(evaluations), complement_(complement), level_(complement ? 0.5 - rounding : 0.5 + rounding) {}

    /// The first crossing in [lo, hi].
    [[gnu::always_inline]] ConvexCrossing first(double lo, double hi, double t_tolerance) const {
        hi = finite_end(lo, hi);
        if (misses(lo, hi, t_tolerance)) return {};
        if (in_ > lo) return enter(in_, hi, t_tolerance);
        const Point p = factors().at(lo);
        if (p.P > level_) return leave(hi, t_tolerance);
        return approach(lo, p, hi, t_tolerance);
    }

    /// Whether there is a crossing in [lo, hi].
    bool any(double lo, double hi, double t_tolerance) const {
        hi = finite_end(lo, hi);
        if (misses(lo, hi, t_tolerance)) return false;
        const double from = std::max(lo, in_), to = std::min(hi, out_);
        if (factors().at(0.5 * (from + to)).P > level_)
            return in_ > lo || out_ <= hi || factors().at(lo).P <= level_ || factors().at(hi).P <= level_;
        return first(lo, hi, t_tolerance).t < infinity;
    }

    /// All crossings in [lo, hi], in order.
    ConvexCrossings all(double lo, double hi, double t_tolerance) const {
        ConvexCrossings found;
        found.start_inside = complement_;
        hi = finite_end(lo, hi);
        if (misses(lo, hi, t_tolerance)) return found;
        const bool within = in_ <= lo && factors().at(lo).P > level_;
        found.start_inside = within != complement_;
        if (!within) {
            const ConvexCrossing c = first(lo, hi, t_tolerance);
            if (!(c.t < infinity)) return found;
            found.at[found.count++] = c;
        }
        const ConvexCrossing c = leave(hi, t_tolerance);
        if (c.t < infinity) {
            found.at[found.count++] = c;
            if (found.count == 2) found.at[1].t = std::max(found.at[1].t, found.at[0].t);
        }
        return found;
    }

protected:
    struct Point {
        double P, slope;
    };

    /// The factor is ½ at t: C begins there or later (begins), or ends there or earlier (ends).
    void begins(double t, int factor) {
        if (t > in_) {
            in_ = t;
            factor_in_ = factor;
        }
    }
    void ends(double t, int factor) {
        if (t < out_) {
            out_ = t;
            factor_out_ = factor;
        }
    }
    void is_empty() {
        in_ = infinity;
        out_ = -infinity;
    }
    double begin() const { return in_; }
    double end() const { return out_; }

    std::uint64_t& evaluations_;
    double rates_ = 0;  // bounds −(log P)″ by 2¼ · rates_, and so the error of a Newton step

private:
    // |P − ½| up to this counts as 0: each of a few factors in [0, 1] contributes an ε of rounding error.
    static constexpr double rounding = RootFinder::rounding;

    const Factors& factors() const { return static_cast<const Factors&>(*this); }

    // Whether C is empty, as on a sharp edge where it ends as it begins, or lies outside of [lo, hi].
    bool misses(double lo, double hi, double t_tolerance) const {
        return !(out_ - in_ > t_tolerance) || in_ > hi || out_ < lo;
    }

    // hi if it is finite, else where the last factor has ceased to vary.
    double finite_end(double lo, double hi) const {
        if (hi < infinity) return hi;
        double end = std::max(lo, in_ < infinity ? in_ : lo);
        if (out_ < infinity) end = std::max(end, out_);
        return std::min(factors().end_of_change(end), 1e300);
    }

    ConvexCrossing found(double t, bool into_C, int factor) const { return {t, into_C != complement_, factor}; }

    int if_sharp(int factor) const { return factor >= factors().soft() ? factor : -1; }

    // The crossing into C, which begins at t or later.
    ConvexCrossing enter(double t, double hi, double t_tolerance) const {
        if (factors().is_alone(factor_in_, t)) return found(t, true, factor_in_);
        const Point p = factors().at(t);
        if (p.P > level_) return found(t, true, if_sharp(factor_in_));
        return approach(t, p, hi, t_tolerance);
    }

    // The crossing into C, from p at t, which is outside of C.
    ConvexCrossing approach(double t, Point p, double hi, double t_tolerance) const {
        const double root = newton(t, p, std::min(hi, out_), t_tolerance);
        return root < infinity ? found(root, true, -1) : ConvexCrossing{};
    }

    // The crossing out of C, if C ends before hi.
    ConvexCrossing leave(double hi, double t_tolerance) const {
        const double t = std::min(hi, out_);
        if (out_ <= hi && factors().is_alone(factor_out_, t)) return found(t, false, factor_out_);
        Point p = factors().at(t);
        if (p.P > level_) return out_ <= hi ? found(t, false, if_sharp(factor_out_)) : ConvexCrossing{};
        p.slope = -p.slope;  // the search is mirrored: it runs backwards from t
        const double distance = newton(0, p, infinity, t_tolerance, t, -1);
        return found(distance < infinity ? t - distance : t, false, -1);
    }

    // The least s' ≥ s at which C begins, or infinity if that is beyond `to`; the ray parameter is base + sign·s, and p
    // is the point at s.
    double newton(double s, Point p, double to, double t_tolerance, double base = 0, double sign = 1) const {
        for (int k = 0; k < max_newton_steps; ++k) {
            if (p.P >= 0.5 - rounding) return p.slope > 0 ? s : infinity;
            if (!(p.slope > 0)) return infinity;
            // The step is a Padé approximant of log 1/x from below, exact to (1 − x)⁵, so it is no longer than Newton's
            // step for log P.
            const double x = 2 * p.P;
            const double step = p.P * (3 * (1 - x * x)) / (p.slope * (1 + x * (4 + x)));
            s += step;
            if (s > to) return infinity;
            // Newton's error after a step is at most ½ |(log P)″|/(log P)′ · step², and (log P)″ ≥ −(2 + ¼) Σ b² where
            // all α ≤ 0.
            if (step <= t_tolerance || 2.25 * rates_ * p.P * step * step <= t_tolerance * p.slope) return s;
            p = factors().at(base + sign * s);
            p.slope *= sign;
        }
        return s;
    }

    bool complement_;
    double level_;  // P exceeds it inside C
    double in_ = -infinity, out_ = infinity;
    int factor_in_ = -1, factor_out_ = -1;
};

}  // namespace deburr
