#include "bounds/convex_density.hpp"

#include <algorithm>

#include "bounds/root_finder.hpp"

namespace deburr {
namespace {

// |P − ½| that rounding can make of 0: products of a few numbers in [0, 1] are off by an ε each.
constexpr double rounding = RootFinder::rounding;

struct Point {
    double P, slope;
};

// A ray's view of the factors. N: their number if known when compiled, else 0.
template <int N>
class Ray {
public:
    Ray(const ConvexView& density, const Vec3& origin, const Vec3& direction, std::uint64_t& evaluations)
        : density_(density), evaluations_(evaluations), level_(density.complement ? 0.5 - rounding : 0.5 + rounding) {
        // C lies where every factor is above ½, to within rounding.
        for (int i = 0; i < soft(); ++i) {
            const AlphaPlane& p = density.planes[i];
            a_[i] = glm::dot(p.slope, origin) + p.base;
            b_[i] = glm::dot(p.slope, direction);
            clip(a_[i], b_[i], i);
            rates_ += b_[i] * b_[i];
        }
        for (int i = 0; i < density.sharp; ++i) {
            const AlphaPlane& p = density.planes[soft() + i];
            clip(glm::dot(p.slope, origin) + p.base, glm::dot(p.slope, direction), soft() + i);
        }
    }

    [[gnu::always_inline]] ConvexCrossing first(double lo, double hi, double t_tolerance) const {
        hi = end_of_change(lo, hi);
        if (misses(lo, hi, t_tolerance)) return {};
        if (in_ > lo) return enter(in_, hi, t_tolerance);
        const Point p = at(lo);
        if (p.P > level_) return leave(hi, t_tolerance);
        return approach(lo, p, hi, t_tolerance);
    }

    bool any(double lo, double hi, double t_tolerance) const {
        hi = end_of_change(lo, hi);
        if (misses(lo, hi, t_tolerance)) return false;
        const double from = std::max(lo, in_), to = std::min(hi, out_);
        if (at(0.5 * (from + to)).P > level_) return in_ > lo || out_ <= hi || at(lo).P <= level_ || at(hi).P <= level_;
        return first(lo, hi, t_tolerance).t < infinity;
    }

    ConvexCrossings all(double lo, double hi, double t_tolerance) const {
        ConvexCrossings found;
        found.start_inside = density_.complement;
        hi = end_of_change(lo, hi);
        if (misses(lo, hi, t_tolerance)) return found;
        const bool within = in_ <= lo && at(lo).P > level_;
        found.start_inside = within != density_.complement;
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

private:
    int soft() const { return N > 0 ? N : density_.soft; }

    // C ends where it begins, as on a sharp edge, or is elsewhere.
    bool misses(double lo, double hi, double t_tolerance) const {
        return !(out_ - in_ > t_tolerance) || in_ > hi || out_ < lo;
    }

    // hi, or, instead of infinity, where the last factor has ceased to vary.
    double end_of_change(double lo, double hi) const {
        if (hi < infinity) return hi;
        double end = std::max(lo, in_ < infinity ? in_ : lo);
        if (out_ < infinity) end = std::max(end, out_);
        for (int i = 0; i < soft(); ++i)
            if (b_[i] != 0) end = std::max(end, (std::abs(a_[i]) + 2) / std::abs(b_[i]));
        return std::min(end, 1e300);
    }

    void clip(double a, double b, int plane) {
        if (b < 0) {
            const double t = -a / b;
            if (t > in_) {
                in_ = t;
                plane_in_ = plane;
            }
        } else if (b > 0) {
            const double t = -a / b;
            if (t < out_) {
                out_ = t;
                plane_out_ = plane;
            }
        } else if (a > 0) {
            in_ = infinity;
            out_ = -infinity;
        }
    }

    // Of the soft factors.
    Point at(double t) const {
        ++evaluations_;
        Point p{1, 0};
        for (int i = 0; i < soft(); ++i) {
            const double alpha = a_[i] + b_[i] * t;
            const double least = alpha < 1 ? alpha : 1, c = least > -1 ? least : -1, u = 1 - c;
            const double F = u * u * (2 + c) * 0.25;
            p.slope = p.slope * F - p.P * (0.75 * u * (1 + c) * b_[i]);
            p.P *= F;
        }
        return p;
    }

    ConvexCrossing found(double t, bool into_C, int plane) const { return {t, into_C != density_.complement, plane}; }

    int if_sharp(int plane) const { return plane >= soft() ? plane : -1; }

    // Where α of this soft plane is 0, all others are 1: P is ½.
    bool is_alone(int plane, double t) const {
        bool alone = plane < soft();
        for (int i = 0; i < soft(); ++i) alone &= i == plane || a_[i] + b_[i] * t <= -1;
        return alone;
    }

    // Into C, which begins at t or later.
    ConvexCrossing enter(double t, double hi, double t_tolerance) const {
        if (is_alone(plane_in_, t)) return found(t, true, plane_in_);
        const Point p = at(t);
        if (p.P > level_) return found(t, true, if_sharp(plane_in_));
        return approach(t, p, hi, t_tolerance);
    }

    // From p outside of C, at t, into C.
    ConvexCrossing approach(double t, Point p, double hi, double t_tolerance) const {
        const double root = newton(t, p, std::min(hi, out_), t_tolerance);
        return root < infinity ? found(root, true, -1) : ConvexCrossing{};
    }

    // Out of C, if it ends before hi.
    ConvexCrossing leave(double hi, double t_tolerance) const {
        const double t = std::min(hi, out_);
        if (out_ <= hi && is_alone(plane_out_, t)) return found(t, false, plane_out_);
        Point p = at(t);
        if (p.P > level_) return out_ <= hi ? found(t, false, if_sharp(plane_out_)) : ConvexCrossing{};
        p.slope = -p.slope;  // mirrored: backwards from t
        const double distance = newton(0, p, infinity, t_tolerance, t, -1);
        return found(distance < infinity ? t - distance : t, false, -1);
    }

    // Distance s ≥ from of C's beginning, if it is not beyond `to`; the ray's parameter is base + sign·s.
    double newton(double s, Point p, double to, double t_tolerance, double base = 0, double sign = 1) const {
        for (int k = 0; k < max_newton_steps; ++k) {
            if (p.P >= 0.5 - rounding) return p.slope > 0 ? s : infinity;
            if (!(p.slope > 0)) return infinity;
            // log 1/x from below: a Padé approximant, exact to (1 − x)⁵. So the step is no longer than
            // Newton's for log P.
            const double x = 2 * p.P;
            const double step = p.P * (3 * (1 - x * x)) / (p.slope * (1 + x * (4 + x)));
            s += step;
            if (s > to) return infinity;
            // Newton's error is squared: ½ |(log P)″|/(log P)′ times, and (log P)″ ≥ −(2 + ¼) Σ b²
            // where all α ≤ 0.
            if (step <= t_tolerance || 2.25 * rates_ * p.P * step * step <= t_tolerance * p.slope) return s;
            p = at(base + sign * s);
            p.slope *= sign;
        }
        return s;
    }

    const ConvexView& density_;
    std::uint64_t& evaluations_;
    double level_;  // inside C is where P exceeds it
    double in_ = -infinity, out_ = infinity, rates_ = 0;
    int plane_in_ = -1, plane_out_ = -1;
    double a_[N > 0 ? N : max_factors], b_[N > 0 ? N : max_factors];
};

template <class Ask>
auto with_ray(const ConvexView& density, const Vec3& origin, const Vec3& direction, std::uint64_t& evaluations,
              Ask ask) {
    switch (density.soft) {
        case 1: return ask(Ray<1>(density, origin, direction, evaluations));
        case 2: return ask(Ray<2>(density, origin, direction, evaluations));
        case 3: return ask(Ray<3>(density, origin, direction, evaluations));
        default: return ask(Ray<0>(density, origin, direction, evaluations));
    }
}

}  // namespace

ConvexCrossing first_crossing(const ConvexView& density, const Vec3& origin, const Vec3& direction, double t0,
                              double t1, double t_tolerance, std::uint64_t& evaluations) {
    return with_ray(density, origin, direction, evaluations,
                    [&](const auto& ray) { return ray.first(t0, t1, t_tolerance); });
}

bool any_crossing(const ConvexView& density, const Vec3& origin, const Vec3& direction, double t0, double t1,
                  double t_tolerance, std::uint64_t& evaluations) {
    return with_ray(density, origin, direction, evaluations,
                    [&](const auto& ray) { return ray.any(t0, t1, t_tolerance); });
}

ConvexCrossings all_crossings(const ConvexView& density, const Vec3& origin, const Vec3& direction, double t0,
                              double t1, double t_tolerance, std::uint64_t& evaluations) {
    return with_ray(density, origin, direction, evaluations,
                    [&](const auto& ray) { return ray.all(t0, t1, t_tolerance); });
}

Vec3 surface_normal(const ConvexView& density, const ConvexCrossing& crossing, const Vec3& x) {
    Vec3 sum(0.0);
    if (crossing.plane >= 0) {
        sum = density.planes[crossing.plane].slope;
    } else {
        // −∇P, but for a factor.
        double P = 1;
        for (int i = 0; i < density.soft; ++i) {
            const AlphaPlane& p = density.planes[i];
            const double alpha = glm::dot(p.slope, x) + p.base, least = alpha < 1 ? alpha : 1;
            const double c = least > -1 ? least : -1, u = 1 - c, F = u * u * (2 + c) * 0.25;
            sum = sum * F + p.slope * (P * (u * (1 + c)));
            P *= F;
        }
    }
    const double length = glm::length(sum);
    return length > 0 ? sum * (1 / length) : sum;
}

}  // namespace deburr
