// Rays from far away, which are restarted near a prototype's surfaces so that rounding does not lose faces.
//
// A point on a ray is rounded in proportion to the largest term of its sum, which far away is the ray's origin. But how
// far beyond its walls a cell knows its solids, and how far bound planes keep clear of a density, follows from the
// prototype's own coordinates (Tolerances). Where the rounding exceeds that, cells are queried outside of what they
// know, and faces are lost. So the origin of a far ray is moved along the ray, once for the whole prototype, to a place
// beside it: o′ = o + start·d. Rounding moves o′ off the ray by ε·|o|, which is as exact as a ray in double precision
// is known; but o′ + t′·d is the same straight line for all cells, and each of its points is rounded in proportion to
// its own coordinates.
#pragma once
#include "raytracer/trace/surface_search.hpp"

namespace deburr {

/// The neighbourhood of a prototype's surfaces, outside of which ray origins count as far.
class Vicinity {
public:
    /// Counts no ray as far.
    Vicinity() = default;
    /// `around` is the box of the prototype's bounded surfaces, or empty. `largest_scale` and `min_scale` are the
    /// largest and least Tolerances::scale of its BSPs, the least one only of those that hold anything.
    Vicinity(const Box& around, double largest_scale, double min_scale) {
        double coordinate_bound = largest_scale;
        radius_ = 2 * coordinate_bound;
        if (!around.empty()) {
            coordinate_bound = std::max({coordinate_bound, largest(around.lo), largest(around.hi)});
            middle_ = 0.5 * (around.lo + around.hi);
            radius_ = 0.5 * glm::length(around.hi - around.lo);
        }
        farthest_ = std::max(nearest_far * coordinate_bound, surely_near * std::min(coordinate_bound, min_scale));
    }

    /// A ray whose origin has a coordinate of larger magnitude is far.
    double farthest() const { return farthest_; }
    bool is_far(const Vec3& origin) const { return largest(origin) > farthest_; }

    /// The parameter at which a far ray comes near: before it enters the ball around `around`, or, if it misses the
    /// ball, before it is nearest to its center. 0 if the ray is not far or leads away.
    double start(const Ray& ray) const {
        if (!is_far(ray.origin)) return 0;
        const double clearance = radius_ + 16 * epsilon * largest(ray.origin);
        const double start = glm::dot(middle_ - ray.origin, ray.direction) - clearance;
        return start > 0 && start < infinity ? start : 0;
    }

private:
    // Chosen so that the rounding of a ray from nearer, 2⁻⁵⁰ (1 + 2·128) of the scale, is less than a fourth of the
    // clearance of bound planes, 2⁻⁴⁰ of the scale. A solid much smaller than the scale would need more, but a ray's
    // coordinates are a few times the scale even near its ball.
    static constexpr double surely_near = 128, nearest_far = 4;

    Vec3 middle_{0.0};                         // of `around`
    double radius_ = 0, farthest_ = infinity;  // of the ball around it; see farthest()
};

/// A far ray in two parts. The first is on the original ray and ends halfway to the prototype's surfaces, where
/// rounding is equal from either end. The second is on the moved ray. A surface between the two is in both.
struct FarRay {
    FarRay(const Ray& ray, double moved_by, double until, double scale)
        : start(moved_by),
          middle(0.5 * start),
          moved{ray.origin + ray.direction * start, ray.direction},
          begin(-middle - rounding_of(scale + largest(ray.origin), middle)),
          t_max(until - start) {}

    double start, middle;  // parameters on the original ray: of the moved origin, and of the end of the first part
    Ray moved;
    double begin, t_max;  // of the second part, on the moved ray
};

}  // namespace deburr
