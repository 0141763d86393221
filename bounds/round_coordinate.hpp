// Coordinates u(x) whose level sets are round: the distances from a point, an axis or a circle, and the coordinate
// across a cone. They are to spheres, cylinders, cones and tori what n·x is to a half-space: u − R is the signed
// distance from the surface u = R near it, so the density profile((u − R)/r) leaves that surface where it is
// [docs/design.md, Round primitives].
//
// Surfaces of one coordinate are parallel: concentric spheres, coaxial cylinders, coaxial cones of one angle.
#pragma once
#include "bounds/range.hpp"
#include "bounds/vec.hpp"

namespace deburr {

/// The coordinate, as a function of the distance s of x from the axis and of the height t = axis·(x − center):
///
///     point    |x − center|
///     axis     across·s + along·t       across² + along² = 1; a cylinder has along = 0
///     circle   √((s − ring)² + t²)
///
/// The gradient is a unit vector wherever u is smooth: everywhere but at the point, on the axis, on the circle and on a
/// circle's axis.
struct RoundCoordinate {
    enum class Kind : unsigned char { point, axis, circle };

    /// |x − center|.
    static RoundCoordinate distance_from_point(Vec3 center);
    /// Distance from the axis through `center`, a unit vector.
    static RoundCoordinate distance_from_axis(Vec3 center, Vec3 axis);
    /// across·s + along·t, which is constant on cones about the axis; across² + along² = 1.
    static RoundCoordinate across_cone(Vec3 center, Vec3 axis, double across, double along);
    /// Distance from the circle of radius `ring` around `center` in the plane perpendicular to the unit vector `axis`.
    static RoundCoordinate distance_from_circle(Vec3 center, Vec3 axis, double ring);

    /// u(x).
    double at(Vec3 x) const;
    /// ∇u, a unit vector; at points without a gradient its radial part is 0.
    Vec3 gradient(Vec3 x) const;
    /// A range that holds u over the box, whose sides may be infinite. It is exact up to rounding, except about an axis
    /// that is not a coordinate axis: there not for circles, nor for infinite boxes.
    Range range(const Box& box) const;
    /// Whether u, or −u, is a convex function of x. Neither is for a circle.
    bool is_convex() const { return kind != Kind::circle && across >= 0; }
    bool is_concave() const { return kind == Kind::axis && across < 0; }
    bool is_cone() const { return kind == Kind::axis && along != 0; }
    /// The coordinate of the other side of a cone's axis, −across·s + along·t.
    RoundCoordinate mirrored() const;
    /// Whether both are the same function, up to rounding.
    bool is_same(const RoundCoordinate& other) const;

    Kind kind = Kind::point;
    Vec3 center{0.0};
    Vec3 axis{0, 0, 1};  // unit; unused by `point`
    /// Only of kind `axis`.
    double across = 1, along = 0;
    /// Radius of the circle; only of kind `circle`.
    double ring = 0;
};

/// The part of space where u(x) ≤ offset.
struct RoundPart {
    RoundCoordinate coordinate;
    double offset;
};

/// The image of the part under a map that keeps angles. It is normalized, so that surfaces of one family have the same
/// coordinate however they came about: the axis points to the side of its first component that is not 0, and the centre
/// of a cylinder or cone is the point of its axis that is nearest to the origin.
RoundPart image(const Affine& map, const RoundPart& part);

/// The factor by which the map lengthens if it keeps angles up to rounding; 0 if it does not.
double even_scale(const Affine& map);

/// A RoundCoordinate along the ray o + t·d.
class RoundOnRay {
public:
    /// Sets the ray. Keeps a reference to `coordinate`.
    void set(const RoundCoordinate& coordinate, Vec3 origin, Vec3 direction);

    /// u at t, and u′ = du/dt; u′ is 0 at a kink.
    double at(double t) const;
    double slope(double t) const;
    /// A range that holds u on [t0, t1]; exact up to rounding except for a circle.
    Range range(double t0, double t1) const;
    /// Upper bounds on [t0, t1] of |u′| and of |u″|, which is infinite where there is a kink.
    double max_slope(double t0, double t1) const;
    double max_curvature(double t0, double t1) const;
    /// The least distance on [t0, t1] from the point or the axis; for a circle a lower bound of the distance from it.
    double least_distance(double t0, double t1) const;
    /// The square of the ray's speed across the axis (point, circle: of its whole speed) per unit of t.
    double square_of_speed() const { return coordinate_->kind == RoundCoordinate::Kind::circle ? whole_ : square_; }
    const RoundCoordinate& coordinate() const { return *coordinate_; }

    /// The parameters at which u crosses `offset`, in order of t.
    struct Crossings {
        int count = 0;
        double t[2];
    };
    /// Crossings of u = offset on the whole line, at most two. Not for circles.
    Crossings crossings(double offset) const;

private:
    double distance(double t) const;  // s at t: distance from the axis or point
    /// The least distance() on [t0, t1].
    double least_on(double t0, double t1) const;
    double height(double t) const { return height_ + climb_ * t; }

    const RoundCoordinate* coordinate_ = nullptr;
    double nearest_ = 0;  // t at which the ray is nearest to the axis or point
    double least_ = 0;    // square of the distance there
    double square_ = 0;   // square of the speed across the axis
    double whole_ = 0;    // square of the whole speed
    /// Height t along the axis at the origin, and its derivative.
    double height_ = 0, climb_ = 0;
};

}  // namespace deburr
