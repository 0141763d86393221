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
    Ray(ConvexView density, Vec3 origin, Vec3 direction, std::uint64_t& evaluations)
        : density_(density), evaluations_(evaluations),
          level_(density.complement ? 0.5 - rounding : 0.5 + rounding) {
        // C lies where every factor is above ½, to within rounding.
        for (int i = 0; i < soft(); ++i) {
            const AlphaPlane& p = density.planes[i];
            a_[i] = glm::dot(p.slope, origin) + p.base;
            b_[i] = glm::dot(p.slope, direction);
            clip(a_[i], b_[i], -1);
            rates_ += b_[i] * b_[i];
        }
        for (int i = 0; i < density.sharp; ++i) {
            const AlphaPlane& p = density.planes[soft() + i];
            clip(glm::dot(p.slope, origin) + p.base, glm::dot(p.slope, direction), soft() + i);
        }
    }

    ConvexCrossing first(double lo, double hi, double negligible) const {
        hi = end_of_change(lo, hi);
        if (misses(lo, hi, negligible)) return {};
        if (in_ > lo) return enter(in_, hi, negligible);
        const Point p = at(lo);
        if (p.P > level_) return leave(hi, negligible);
        return approach(lo, p, hi, negligible);
    }

    bool any(double lo, double hi, double negligible) const {
        hi = end_of_change(lo, hi);
        if (misses(lo, hi, negligible)) return false;
        const double from = std::max(lo, in_), to = std::min(hi, out_);
        if (at(0.5 * (from + to)).P > level_)
            return in_ > lo || out_ <= hi || at(lo).P <= level_ || at(hi).P <= level_;
        return first(lo, hi, negligible).t < infinity;
    }

    ConvexCrossings all(double lo, double hi, double negligible) const {
        ConvexCrossings found;
        found.start_inside = density_.complement;
        hi = end_of_change(lo, hi);
        if (misses(lo, hi, negligible)) return found;
        const bool within = in_ <= lo && at(lo).P > level_;
        found.start_inside = within != density_.complement;
        if (!within) {
            const ConvexCrossing c = first(lo, hi, negligible);
            if (!(c.t < infinity)) return found;
            found.at[found.count++] = c;
        }
        const ConvexCrossing c = leave(hi, negligible);
        if (c.t < infinity) {
            found.at[found.count++] = c;
            if (found.count == 2) found.at[1].t = std::max(found.at[1].t, found.at[0].t);
        }
        return found;
    }

private:
    int soft() const { return N > 0 ? N : density_.soft; }

    // C ends where it begins, as on a sharp edge, or is elsewhere.
    bool misses(double lo, double hi, double negligible) const {
        return !(out_ - in_ > negligible) || in_ > hi || out_ < lo;
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

    void clip(double a, double b, int sharp) {
        if (b < 0) {
            const double t = -a / b;
            if (t > in_) {
                in_ = t;
                sharp_in_ = sharp;
            }
        } else if (b > 0) {
            const double t = -a / b;
            if (t < out_) {
                out_ = t;
                sharp_out_ = sharp;
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
            const double c = alpha < -1 ? -1 : alpha > 1 ? 1 : alpha, u = 1 - c;
            const double F = u * u * (2 + c) * 0.25;
            p.slope = p.slope * F - p.P * (0.75 * u * (1 + c) * b_[i]);
            p.P *= F;
        }
        return p;
    }

    ConvexCrossing found(double t, bool into_C, int sharp) const {
        return {t, into_C != density_.complement, sharp};
    }

    // Into C, which begins at t or later.
    ConvexCrossing enter(double t, double hi, double negligible) const {
        const Point p = at(t);
        if (p.P > level_) return found(t, true, sharp_in_);
        return approach(t, p, hi, negligible);
    }

    // From p outside of C, at t, into C.
    ConvexCrossing approach(double t, Point p, double hi, double negligible) const {
        const double root = newton(t, p, std::min(hi, out_), negligible);
        return root < infinity ? found(root, true, -1) : ConvexCrossing{};
    }

    // Out of C, if it ends before hi.
    ConvexCrossing leave(double hi, double negligible) const {
        const double t = std::min(hi, out_);
        Point p = at(t);
        if (p.P > level_) return out_ <= hi ? found(t, false, sharp_out_) : ConvexCrossing{};
        p.slope = -p.slope;  // mirrored: backwards from t
        const double way = newton(0, p, infinity, negligible, t, -1);
        return found(way < infinity ? t - way : t, false, -1);
    }

    // Distance s ≥ from of C's beginning, if it is not beyond `to`; the ray's parameter is base + sign·s.
    double newton(double s, Point p, double to, double negligible, double base = 0, double sign = 1) const {
        for (int k = 0; k < most_steps; ++k) {
            if (p.P >= 0.5 - rounding) return p.slope > 0 ? s : infinity;
            if (!(p.slope > 0)) return infinity;
            // log 1/x from below: a Padé approximant, exact to (1 − x)⁵. So the step is no longer than
            // Newton's for log P.
            const double x = 2 * p.P;
            const double step = (p.P / p.slope) * (3 * (1 - x * x) / (1 + x * (4 + x)));
            s += step;
            if (s > to) return infinity;
            // Newton's error is squared: ½ |(log P)″|/(log P)′ times, and (log P)″ ≥ −(2 + ¼) Σ b²
            // where all α ≤ 0.
            if (step <= negligible || 2.25 * rates_ * (p.P / p.slope) * step * step <= negligible) return s;
            p = at(base + sign * s);
            p.slope *= sign;
        }
        return s;
    }

    // Steps shrink quadratically, or by half where the ray touches C: then to the root of ε.
    static constexpr int most_steps = 100;

    ConvexView density_;
    std::uint64_t& evaluations_;
    double level_;  // inside C is where P exceeds it
    double in_ = -infinity, out_ = infinity, rates_ = 0;
    int sharp_in_ = -1, sharp_out_ = -1;
    double a_[N > 0 ? N : most_factors], b_[N > 0 ? N : most_factors];
};

template <class Ask>
auto with_ray(ConvexView density, Vec3 origin, Vec3 direction, std::uint64_t& evaluations, Ask ask) {
    switch (density.soft) {
        case 1: return ask(Ray<1>(density, origin, direction, evaluations));
        case 2: return ask(Ray<2>(density, origin, direction, evaluations));
        case 3: return ask(Ray<3>(density, origin, direction, evaluations));
        default: return ask(Ray<0>(density, origin, direction, evaluations));
    }
}

}  // namespace

ConvexCrossing first_crossing(ConvexView density, Vec3 origin, Vec3 direction, double t0, double t1,
                              double negligible, std::uint64_t& evaluations) {
    return with_ray(density, origin, direction, evaluations,
                    [&](const auto& ray) { return ray.first(t0, t1, negligible); });
}

bool any_crossing(ConvexView density, Vec3 origin, Vec3 direction, double t0, double t1, double negligible,
                  std::uint64_t& evaluations) {
    return with_ray(density, origin, direction, evaluations,
                    [&](const auto& ray) { return ray.any(t0, t1, negligible); });
}

ConvexCrossings all_crossings(ConvexView density, Vec3 origin, Vec3 direction, double t0, double t1,
                              double negligible, std::uint64_t& evaluations) {
    return with_ray(density, origin, direction, evaluations,
                    [&](const auto& ray) { return ray.all(t0, t1, negligible); });
}

Vec3 surface_normal(ConvexView density, const ConvexCrossing& crossing, Vec3 x) {
    Vec3 sum(0.0);
    if (crossing.sharp >= 0) {
        sum = density.planes[crossing.sharp].slope;
    } else {
        // ∇ log P = Σ F′/F ∇α, and −F′/F = 3(1 + α)/((1 − α)(2 + α)); α ≤ 0 but for rounding.
        for (int i = 0; i < density.soft; ++i) {
            const AlphaPlane& p = density.planes[i];
            const double alpha = std::min(0.5, glm::dot(p.slope, x) + p.base);
            if (alpha > -1) sum += p.slope * ((1 + alpha) / ((1 - alpha) * (2 + alpha)));
        }
    }
    const double length = glm::length(sum);
    return length > 0 ? sum / length : sum;
}

// ---- recognition ---------------------------------------------------------------------------------

namespace {

AlphaPlane alpha_plane(const HalfSpace& h, bool flipped) {
    const double per = (flipped ? -1 : 1) / (h.radius > 0 ? h.radius : 1.0);
    return {h.normal * per, -h.offset * per};
}

// A half-space as a variable in [0, 1] or one minus it.
struct Occurrence {
    int variable = 0;
    bool flipped = false;
};

// The least number of variables: coinciding planes share one.
std::vector<Occurrence> occurrences(const std::vector<HalfSpace>& planes, double scale) {
    constexpr double slack = 8 * epsilon;
    std::vector<Occurrence> all;
    for (std::size_t i = 0; i < planes.size(); ++i) {
        const HalfSpace& h = planes[i];
        Occurrence l{int(i), false};
        for (std::size_t j = 0; j < i && l.variable == int(i); ++j) {
            const HalfSpace& g = planes[j];
            if (all[j].variable != int(j) || std::abs(g.radius - h.radius) > slack * g.radius) continue;
            const double sign = glm::dot(g.normal, h.normal) < 0 ? -1 : 1;
            if (glm::length(sign * h.normal - g.normal) <= slack && std::abs(sign * h.offset - g.offset) <= slack * scale)
                l = {int(j), sign < 0};
        }
        all.push_back(l);
    }
    return all;
}

// Above this many variables the corners are not counted out.
constexpr int most_variables = 6;

}  // namespace

std::optional<ConvexDensity> convex_density(const LocalDensity& density, double scale) {
    const std::vector<HalfSpace>& planes = density.half_spaces();
    if (planes.size() > std::size_t(most_factors)) return std::nullopt;
    ConvexDensity result;
    std::vector<Occurrence> factors;
    if (const auto product = density.as_product()) {
        result.complement = product->complement;
        for (const auto& [plane, flipped] : product->factors) factors.push_back({plane, flipped});
    } else {
        // A polynomial that is affine in each variable is known by its values where all are 0 or 1.
        // It is a product if one of these is 1 and the others 0.
        const std::vector<Occurrence> of = occurrences(planes, scale);
        std::vector<int> variables;
        std::vector<int> variable_of;
        for (std::size_t i = 0; i < of.size(); ++i) {
            variable_of.push_back(of[i].variable);
            if (of[i].variable == int(i)) variables.push_back(int(i));
        }
        const int n = int(variables.size());
        if (n > most_variables || !density.is_affine_in_each(variable_of)) return std::nullopt;
        std::vector<char> value;
        std::vector<Range> at(planes.size());
        for (int corner = 0; corner < 1 << n; ++corner) {
            for (std::size_t i = 0; i < planes.size(); ++i) {
                const auto v = std::find(variables.begin(), variables.end(), of[i].variable) - variables.begin();
                const double rho = ((corner >> v & 1) != 0) != of[i].flipped;
                at[i] = {rho, rho};
            }
            const Range rho = density.range(at);
            if (rho.lo != rho.hi || (rho.lo != 0 && rho.lo != 1)) return std::nullopt;
            value.push_back(rho.lo == 1);
        }
        int relevant = 0;
        for (int v = 0; v < n; ++v)
            for (int corner = 0; corner < 1 << n; ++corner)
                if (value[std::size_t(corner)] != value[std::size_t(corner ^ 1 << v)]) relevant |= 1 << v;
        int ones = 0, zeros = 0, the_one = 0, the_zero = 0;
        for (int corner = 0; corner < 1 << n; ++corner) {
            if ((corner & ~relevant) != 0) continue;
            (value[std::size_t(corner)] ? ones : zeros)++;
            (value[std::size_t(corner)] ? the_one : the_zero) = corner;
        }
        if (relevant == 0 || (ones != 1 && zeros != 1)) return std::nullopt;
        result.complement = ones != 1;
        const int corner = result.complement ? the_zero : the_one;
        for (int v = 0; v < n; ++v)
            if (relevant >> v & 1) factors.push_back({variables[std::size_t(v)], (corner >> v & 1) == 0});
    }
    for (const bool sharp : {false, true})
        for (const auto [i, flipped] : factors) {
            const HalfSpace& h = planes[std::size_t(i)];
            if ((h.radius == 0) != sharp) continue;
            result.planes.push_back(alpha_plane(h, flipped));
            result.sharp += sharp;
        }
    return result;
}

}  // namespace deburr
