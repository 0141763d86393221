// Coordinates whose level sets are round: the distances from a point, an axis or a circle, and the coordinate across a
// cone. They are to spheres, cylinders, cones and tori what n·x is to a half-space: the surface u = R has the signed
// distance u − R beside it, so that the density profile((u − R)/r) keeps it where it is
// [docs/design.md, Round primitives].
//
// Surfaces of one coordinate are parallel: concentric spheres, coaxial cylinders, coaxial cones of one angle.
#pragma once
#include "bounds/range.hpp"
#include "bounds/vec.hpp"

namespace deburr {

/// With s, the distance of x from the axis, and t = axis·(x − center):
///
///     point    |x − center|
///     axis     across·s + along·t       across² + along² = 1; a cylinder has along = 0
///     circle   √((s − ring)² + t²)
///
/// Its gradient is a unit vector wherever it is smooth, which is everywhere but at the point, on the axis or on the
/// circle, and, for a circle, on its axis.
struct RoundCoordinate {
    enum class Kind : unsigned char { point, axis, circle };

    static RoundCoordinate distance_from_point(Vec3 center);
    static RoundCoordinate distance_from_axis(Vec3 center, Vec3 axis);
    /// Constant along lines that run from `center` at the angle atan(across/along) to the axis turned by 90°.
    static RoundCoordinate across_cone(Vec3 center, Vec3 axis, double across, double along);
    static RoundCoordinate distance_from_circle(Vec3 center, Vec3 axis, double ring);

    double at(Vec3 x) const;
    /// A unit vector; 0 where there is none.
    Vec3 gradient(Vec3 x) const;
    /// Holds the values over the box, whose sides may be infinite. The least and the greatest, but for circles about an
    /// axis that is not a coordinate axis.
    Range range(const Box& box) const;
    /// Whether it is convex; its negative is if `across` < 0, and neither is for a circle.
    bool is_convex() const { return kind != Kind::circle && across >= 0; }
    bool is_concave() const { return kind == Kind::axis && across < 0; }
    bool is_cone() const { return kind == Kind::axis && along != 0; }
    /// The coordinate in which a cone is seen from the other side of the axis: −across·s + along·t.
    RoundCoordinate mirrored() const;
    /// Whether two are the same function, but for rounding.
    bool is_same(const RoundCoordinate& other) const;

    Kind kind = Kind::point;
    Vec3 center{0.0};
    Vec3 axis{0, 0, 1};  // unit
    double across = 1, along = 0;
    double ring = 0;
};

/// A part of space u(x) ≤ offset.
struct RoundPart {
    RoundCoordinate coordinate;
    double offset;
};

/// The image of the part under a map that keeps angles, written so that surfaces of one family have the same coordinate
/// however they came about: the axis points to the side of its first component that is not 0, and the center of a
/// cylinder or cone is the point of its axis that is nearest to the origin.
RoundPart image(const Affine& map, const RoundPart& part);

/// By how much the map lengthens, if it keeps angles to within rounding; 0 if it does not.
double even_scale(const Affine& map);

/// The coordinate along the ray o + t·d.
class RoundOnRay {
public:
    void set(const RoundCoordinate& coordinate, Vec3 origin, Vec3 direction);

    double at(double t) const;
    double slope(double t) const;
    /// Holds the values on [t0, t1]: the least and greatest of them, but for a circle.
    Range range(double t0, double t1) const;
    /// Upper bounds on [t0, t1] of |u′|, and of |u″| (infinite where a kink is met).
    double max_slope(double t0, double t1) const;
    double max_curvature(double t0, double t1) const;
    /// Least distance from the point or the axis on [t0, t1]; of a circle, from the circle, or less.
    double least_distance(double t0, double t1) const;
    /// The square of the speed across the axis, or of the whole of it.
    double square_of_speed() const { return coordinate_->kind == RoundCoordinate::Kind::circle ? whole_ : square_; }
    const RoundCoordinate& coordinate() const { return *coordinate_; }

    /// Where u crosses `offset`, in order of t.
    struct Crossings {
        int count = 0;
        double t[2];
    };
    /// Not for circles.
    Crossings crossings(double offset) const;

private:
    double distance(double t) const;  // from the axis, or the point
    double least_on(double t0, double t1) const;
    double height(double t) const { return height_ + climb_ * t; }

    const RoundCoordinate* coordinate_ = nullptr;
    double nearest_ = 0;  // where the ray is nearest to the axis
    double least_ = 0;    // the square of the distance there
    double square_ = 0;   // of the speed across
    double whole_ = 0;    // square of the speed
    double height_ = 0, climb_ = 0;
};

}  // namespace deburr
