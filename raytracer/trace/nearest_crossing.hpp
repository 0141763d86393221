// The first of the crossings that a search has come upon.
//
// Which it is does not depend on the order in which they are come upon: it is the least by (t, solid, number of
// the surface). Its normal is computed when all is done.
#pragma once
#include "raytracer/trace/cell_primitive.hpp"
#include "raytracer/trace/ray_tracer.hpp"

namespace deburr {

struct FoundSurface {
    SurfaceCrossing crossing;  // t = infinity: none
    int solid = -1;            // the number that the prototype gives it
    double error = 0;          // of the position: what floating point rounds it by
    double start = 0;          // crossing.t counts from here on the ray that was asked for
};

class NearestCrossing {
public:
    /// Begins without a crossing; none beyond `end` counts.
    explicit NearestCrossing(double end = infinity) : end_(end) {}

    bool found() const { return found_; }
    double end() const { return end_; }

    /// Offers a crossing of primitive `number` of `primitives`, a plane or a product of half-spaces.
    void offer(const CellPrimitives& primitives, std::uint32_t number, const ConvexCrossing& c) {
        const CellPrimitive& p = primitives[number];
        if (!take(c.t, p.solid, number)) return;
        primitives_ = &primitives;
        entering_ = c.entering;  // not copied as a whole, which would wait for its parts
        plane_ = c.plane;
        material_ = p.material;
        error_ = 0;
    }
    /// Offers a crossing whose normal is known, of a primitive or of an instance.
    void offer(const SurfaceCrossing& c, double error, int solid, std::uint32_t number) {
        if (!take(c.t, solid, number)) return;
        primitives_ = nullptr;
        normal_ = c.normal;
        material_ = c.material;
        error_ = error;
    }

    /// The nearest crossing's surface; `rounding` is the rounding error of a point on a ray of this prototype.
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
    // Of which it is, if it is still without its normal.
    const CellPrimitives* primitives_ = nullptr;
    bool entering_ = false;
    int plane_ = -1;
    Vec3 normal_{0.0};
    int material_ = 0;
    double error_ = 0;
};

}  // namespace deburr
