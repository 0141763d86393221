#include "bounds/convex_density.hpp"

#include <algorithm>

#include "bounds/clamped_alpha.hpp"
#include "bounds/convex_search.hpp"

namespace deburr {
namespace {

// The soft factors along a ray. N is their number if it is known at compile time, else 0.
template <int N>
class Ray : public ConvexSearch<Ray<N>> {
    using Search = ConvexSearch<Ray<N>>;
    using typename Search::Point;
    friend Search;

public:
    Ray(const ConvexView& density, const Vec3& origin, const Vec3& direction, std::uint64_t& evaluations)
        : Search(density.complement, evaluations), density_(density) {
        // C lies where every factor is above ½, up to rounding.
        for (int i = 0; i < soft(); ++i) {
            const AlphaPlane& p = density.planes[i];
            a_[i] = glm::dot(p.slope, origin) + p.base;
            b_[i] = glm::dot(p.slope, direction);
            clip(a_[i], b_[i], i);
            this->rates_ += b_[i] * b_[i];
        }
        for (int i = 0; i < density.sharp; ++i) {
            const AlphaPlane& p = density.planes[soft() + i];
            clip(glm::dot(p.slope, origin) + p.base, glm::dot(p.slope, direction), soft() + i);
        }
    }

private:
    int soft() const { return N > 0 ? N : density_.soft; }

    double end_of_change(double end) const {
        for (int i = 0; i < soft(); ++i)
            if (b_[i] != 0) end = std::max(end, (std::abs(a_[i]) + 2) / std::abs(b_[i]));
        return end;
    }

    void clip(double a, double b, int plane) {
        if (b < 0)
            this->begins(-a / b, plane);
        else if (b > 0)
            this->ends(-a / b, plane);
        else if (a > 0)
            this->is_empty();
    }

    // Product of the soft factors at t, and its slope.
    Point at(double t) const {
        ++this->evaluations_;
        Point p{1, 0};
        for (int i = 0; i < soft(); ++i) {
            const double alpha = a_[i] + b_[i] * t;
            const double c = clamped_alpha(alpha), u = 1 - c;
            const double F = u * u * (2 + c) * 0.25;
            p.slope = p.slope * F - p.P * (0.75 * u * (1 + c) * b_[i]);
            p.P *= F;
        }
        return p;
    }

    // Whether P is ½ where α of this soft plane is 0 at t: all other soft factors are 1 there.
    bool is_alone(int plane, double t) const {
        bool alone = plane < soft();
        for (int i = 0; i < soft(); ++i) alone &= i == plane || a_[i] + b_[i] * t <= -1;
        return alone;
    }

    const ConvexView& density_;
    double a_[N > 0 ? N : max_factors], b_[N > 0 ? N : max_factors];
};

template <class Ask>
[[gnu::always_inline]] inline auto with_ray(const ConvexView& density, const Vec3& origin, const Vec3& direction,
                                            std::uint64_t& evaluations, Ask ask) {
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
        // −∇P, up to a positive factor.
        double P = 1;
        for (int i = 0; i < density.soft; ++i) {
            const AlphaPlane& p = density.planes[i];
            const double c = clamped_alpha(glm::dot(p.slope, x) + p.base), u = 1 - c, F = u * u * (2 + c) * 0.25;
            sum = sum * F + p.slope * (P * (u * (1 + c)));
            P *= F;
        }
    }
    const double length = glm::length(sum);
    return length > 0 ? sum * (1 / length) : sum;
}

}  // namespace deburr
