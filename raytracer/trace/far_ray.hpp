// Rays from far away, which are begun anew where they come near a prototype's surfaces.
//
// A point of a ray is rounded in proportion to the largest number that it is added up from, and from far away that
// is the ray's origin. How far beyond its walls a cell knows its solids, and how far bounds keep clear of a density,
// is set by the prototype's own coordinates (Tolerances). Where the rounding is more than that, a cell is asked about
// places that it knows nothing of, and faces are lost. So the origin of a far ray is moved along the ray, once for
// the whole prototype, to o′ = o + start·d, beside it. Rounding moves o′ off the ray by ε·|o|, and a ray in double
// precision is not known any better; but o′ + t′·d is one straight line for all cells, on which every point is
// rounded in proportion to its own coordinates.
#pragma once
#include "raytracer/trace/surface_search.hpp"

namespace deburr {

class Vicinity {
public:
    /// No ray is far.
    Vicinity() = default;
    /// `around` is the box of a prototype's bounded surfaces, or empty; the scales are those of its BSPs' tolerances,
    /// the least of those that hold anything.
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

    /// Rays that begin beyond, by their largest coordinate, may have to be moved.
    double farthest() const { return farthest_; }
    bool is_far(const Vec3& origin) const { return largest(origin) > farthest_; }

    /// Parameter of a ray from far away where it comes near: before it enters the ball around `around`, or, if it
    /// does not, before it is nearest to its middle. 0: the ray begins near the ball, or leads away from it.
    double start(const Ray& ray) const {
        if (!is_far(ray.origin)) return 0;
        const double clearance = radius_ + 16 * epsilon * largest(ray.origin);
        const double start = glm::dot(middle_ - ray.origin, ray.direction) - clearance;
        return start > 0 && start < infinity ? start : 0;
    }

private:
    // Chosen: rounding of a ray from nearer, 2⁻⁵⁰ (1 + 2·128) of the scale, is less than a fourth of what bounds keep
    // clear by, 2⁻⁴⁰ of it. Solids much smaller than the scale would need more, but even near its ball a ray's
    // coordinates are some times the scale.
    static constexpr double surely_near = 128, nearest_far = 4;

    Vec3 middle_{0.0};
    double radius_ = 0, farthest_ = infinity;
};

/// A ray from far away, in two parts. The first ends halfway to the prototype's surfaces, where rounding from either
/// end is the same. The second is the moved ray's. A surface between them is in both.
struct FarRay {
    FarRay(const Ray& ray, double moved_by, double until, double scale)
        : start(moved_by),
          middle(0.5 * start),
          moved{ray.origin + ray.direction * start, ray.direction},
          begin(-middle - rounding_of(scale + largest(ray.origin), middle)),
          t_max(until - start) {}

    double start, middle;
    Ray moved;
    double begin, t_max;  // of the second part, on the moved ray
};

}  // namespace deburr
