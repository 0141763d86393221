#include "bounds/round_product.hpp"

#include <algorithm>

#include "bounds/convex_search.hpp"
#include "bounds/torus.hpp"

namespace deburr {

namespace {

/// The surface, unless it is a torus that TorusOnRay does not handle.
std::optional<RoundSurface> if_crossed_safely(const RoundSurface& surface) {
    const double ring = surface.coordinate.ring, tube = surface.offset;
    if (surface.is_torus() && !(tube >= TorusOnRay::least_tube * ring && tube <= ring)) return std::nullopt;
    return surface;
}

}  // namespace

std::optional<RoundSurface> RoundSurface::of(const LocalDensity& density) {
    if (density.half_spaces().size() != 1 || !density.half_spaces()[0].round) return std::nullopt;
    const HalfSpace& h = density.half_spaces()[0];
    // ρ is affine in the half-space's density F: ρ = v₀ + (v₁ − v₀)·F.
    const Range one[] = {{1, 1}}, zero[] = {{0, 0}};
    const double v1 = density.range(one).lo, v0 = density.range(zero).lo;
    if ((v0 > 0.5) == (v1 > 0.5)) return std::nullopt;
    return if_crossed_safely({*h.round, h.offset + h.radius * displacement((0.5 - v0) / (v1 - v0)), v0 > 0.5});
}

std::optional<RoundSurface> RoundSurface::of(const Torus& torus) {
    return if_crossed_safely(
        {RoundCoordinate::distance_from_circle(torus.center(), torus.axis(), torus.radius()), torus.tube(), false});
}

RoundCrossings RoundSurface::crossings(const Vec3& origin, const Vec3& direction, double t0, double t1) const {
    if (is_torus()) return TorusOnRay(coordinate, offset, complement, origin, direction, t0, t1).crossings();
    RoundOnRay ray;
    ray.set(coordinate, origin, direction);
    RoundCrossings all;
    bool inside = (ray.at(t0) <= offset) != complement;
    all.start_inside = inside;
    const RoundOnRay::Crossings on_ray = ray.crossings(offset);
    for (int i = 0; i < on_ray.count; ++i) {
        const double t = on_ray.t[i];
        if (!(t >= t0 && t <= t1)) continue;
        inside = (ray.slope(t) < 0) != complement;
        // A crossing at t0 itself may be part of start_inside already.
        if (all.count == 0 && inside == all.start_inside) continue;
        all.at[all.count++] = {t, inside, -1};
    }
    return all;
}

Vec3 RoundSurface::normal(const Vec3& x) const {
    const Vec3 out = coordinate.gradient(x);
    return complement ? -out : out;
}

std::optional<RoundProduct> RoundProduct::of(const LocalDensity& density) {
    const std::optional<LocalDensity::Product> product = density.as_product();
    if (!product || product->factors.size() > std::size_t(max_factors)) return std::nullopt;
    RoundProduct result;
    result.complement_ = product->complement;
    result.rounds_ = density.rounds();
    for (const auto& [index, flipped] : product->factors) {
        HalfSpace h = density.half_spaces()[std::size_t(index)];
        if (h.radius == 0 || (h.round && (flipped || h.round->kind == RoundCoordinate::Kind::circle)))
            return std::nullopt;
        if (flipped) {
            h.normal = -h.normal;
            h.offset = -h.offset;
        }
        result.factors_.push_back(h);
    }
    // The mirrored side of a cone is log-concave only together with the cone itself.
    for (const HalfSpace& h : result.factors_) {
        if (!h.round || h.round->is_convex()) continue;
        const RoundCoordinate other = h.round->mirrored();
        if (std::none_of(result.factors_.begin(), result.factors_.end(),
                         [&](const HalfSpace& k) { return k.round && k.round->is_same(other); }))
            return std::nullopt;
    }
    return result;
}

/// The factors of a RoundProduct along a ray.
class RoundProductRay : public ConvexSearch<RoundProductRay> {
public:
    RoundProductRay(const RoundProduct& product, const Vec3& origin, const Vec3& direction, std::uint64_t& evaluations)
        : ConvexSearch(product.complement_, evaluations) {
        for (const HalfSpace& h : product.factors_) {
            Factor& f = factors_.emplace_back();
            const int number = int(factors_.size()) - 1;
            if (!h.round) {
                f.a = h.distance(origin) / h.radius;
                f.b = glm::dot(h.normal, direction) / h.radius;
                if (f.b < 0)
                    begins(-f.a / f.b, number);
                else if (f.b > 0)
                    ends(-f.a / f.b, number);
                else if (f.a > 0)
                    is_empty();
                continue;
            }
            f.is_round = true;
            f.round.set(*h.round, origin, direction);
            f.offset = h.offset;
            f.inverse_radius = 1 / h.radius;
            if (h.round->is_convex()) clip(f.round, h.offset, number);
        }
        // rates_ bounds −(log P)″, which is at most 2¼ Σ α′² + 1½ Σ α″ where all α ≤ 0.
        const double from = std::max(begin(), -1e30), to = std::min(end(), 1e30);
        if (!(from < to)) return;
        for (const Factor& f : factors_) {
            const double slope = f.is_round ? f.round.max_slope(from, to) * f.inverse_radius : f.b;
            rates_ += slope * slope;
            if (f.is_round) rates_ += f.round.max_curvature(from, to) * f.inverse_radius / 1.5;
        }
    }

    int soft() const { return int(factors_.size()); }

    Point at(double t) const {
        ++evaluations_;
        Point p{1, 0};
        for (const Factor& f : factors_) {
            const double alpha = f.alpha(t), F = profile(alpha);
            p.slope =
                p.slope * F + p.P * (profile_slope(alpha) * (f.is_round ? f.round.slope(t) * f.inverse_radius : f.b));
            p.P *= F;
        }
        return p;
    }

    bool is_alone(int factor, double t) const {
        for (int i = 0; i < soft(); ++i)
            if (i != factor && !(factors_[std::size_t(i)].alpha(t) <= -1)) return false;
        return true;
    }

    double end_of_change(double end) const {
        for (const Factor& f : factors_) {
            if (!f.is_round) {
                if (f.b != 0) end = std::max(end, (std::abs(f.a) + 2) / std::abs(f.b));
                continue;
            }
            for (const double side : {-1.0, 1.0}) {
                const RoundOnRay::Crossings c = f.round.crossings(f.offset + side / f.inverse_radius);
                for (int i = 0; i < c.count; ++i) end = std::max(end, c.t[i]);
            }
        }
        return end;
    }

private:
    struct Factor {
        bool is_round = false;
        double a = 0, b = 0;  // of a plane: α = a + b·t
        RoundOnRay round;
        double offset = 0, inverse_radius = 0;

        double alpha(double t) const { return is_round ? (round.at(t) - offset) * inverse_radius : a + b * t; }
    };

    // Clips to where a convex coordinate is at most its offset: between its two crossings, or on one side of the only
    // one.
    void clip(const RoundOnRay& round, double offset, int number) {
        const RoundOnRay::Crossings c = round.crossings(offset);
        if (c.count == 2) {
            begins(c.t[0], number);
            ends(c.t[1], number);
        } else if (c.count == 1) {
            round.slope(c.t[0]) < 0 ? begins(c.t[0], number) : ends(c.t[0], number);
        } else if (!(round.at(0) <= offset)) {
            is_empty();
        }
    }

    std::vector<Factor>& factors_ = memory();
    static std::vector<Factor>& memory() {
        thread_local std::vector<Factor> own;
        own.clear();
        return own;
    }
};

ConvexCrossings RoundProduct::crossings(const Vec3& origin, const Vec3& direction, double t0, double t1,
                                        double t_tolerance, std::uint64_t& evaluations) const {
    return RoundProductRay(*this, origin, direction, evaluations).all(t0, t1, t_tolerance);
}

Vec3 RoundProduct::normal(const Vec3& x) const {
    Vec3 sum(0.0);
    double P = 1;
    for (const HalfSpace& h : factors_) {
        const double alpha = h.alpha(x), F = profile(alpha);
        sum = sum * F - h.normal_at(x) * (P * profile_slope(alpha) / h.radius);
        P *= F;
    }
    const double length = glm::length(sum);
    return length > 0 ? sum / length : sum;
}

}  // namespace deburr
