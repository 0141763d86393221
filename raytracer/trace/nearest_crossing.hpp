// Keeps the nearest of the crossings that a search finds.
//
// The choice does not depend on the order in which crossings are offered: the least by (t, solid, number of the
// surface) is kept. Its normal is computed only at the end.
#pragma once
#include "raytracer/trace/cell_primitive.hpp"
#include "raytracer/trace/ray_tracer.hpp"

namespace deburr {

/// The surface that a search found, in the coordinates of a prototype.
struct FoundSurface {
    SurfaceCrossing crossing;  // its t is infinity if there is none
    int solid = -1;            // number within the prototype
    double error = 0;          // of the position, by rounding (a scene length)
    double start = 0;          // crossing.t counts from this parameter of the original ray (far_ray.hpp)
};

/// The nearest of the crossings that were offered.
class NearestCrossing {
public:
    /// Holds no crossing; crossings beyond `end` are ignored.
    explicit NearestCrossing(double end = infinity) : end_(end) {}

    /// Whether there is a crossing.
    bool found() const { return found_; }
    /// Its t, or the end of the search while there is none.
    double end() const { return end_; }

    /// Offers a crossing of a plane or convex primitive, number `number` of `primitives`, whose normal is still
    /// unknown.
    void offer(const CellPrimitives& primitives, std::uint32_t number, const ConvexCrossing& c) {
        const CellPrimitive& p = primitives[number];
        if (!take(c.t, p.solid, number)) return;
        primitives_ = &primitives;
        entering_ = c.entering;  // not copied as a whole, which would wait for its parts
        plane_ = c.plane;
        material_ = p.material;
        error_ = 0;
    }
    /// Offers a crossing with a known normal, of a primitive or an instance.
    void offer(const SurfaceCrossing& c, double error, int solid, std::uint32_t number) {
        if (!take(c.t, solid, number)) return;
        primitives_ = nullptr;
        normal_ = c.normal;
        material_ = c.material;
        error_ = error;
    }

    /// The nearest surface. `rounding` is the rounding error of a point on a ray of this prototype.
    [[gnu::always_inline]] FoundSurface surface(const Ray& ray, double rounding) const {
        if (!found_) return {};
        if (!primitives_) return {{end_, normal_, material_}, solid_, error_};
        return {
            {end_, primitives_->normal((*primitives_)[number_], {end_, entering_, plane_}, ray.origin, ray.direction),
             material_},
            solid_,
            rounding};
    }

private:
    // Makes this the nearest crossing if it comes before the present one.
    bool take(double t, int solid, std::uint32_t number) {
        if (!(t < end_) && !(t == end_ && (!found_ || solid < solid_ || (solid == solid_ && number < number_))))
            return false;
        found_ = true;
        end_ = t;
        solid_ = solid;
        number_ = number;
        return true;
    }

    double end_;
    bool found_ = false;
    int solid_ = -1;
    std::uint32_t number_ = 0;
    // The list of the nearest primitive while its normal is unknown; else null, and the normal is in normal_.
    const CellPrimitives* primitives_ = nullptr;
    bool entering_ = false;
    int plane_ = -1;
    Vec3 normal_{0.0};
    int material_ = 0;
    double error_ = 0;
};

}  // namespace deburr
