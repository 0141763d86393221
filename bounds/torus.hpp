// The inside of a sharp torus as the field
//
//     f = 4R²s² − (s² + t² + R² − a²)² = (a² − q²)(p² − a²),      q², p² = (s ∓ R)² + t²
//
// a polynomial of degree four. s is the distance from the axis and t the height along it, R the radius of the circle
// and a ≤ R that of the tube.
#pragma once
#include "bounds/field.hpp"

namespace deburr {

/// The set f > 0 above.
class Torus final : public Field {
public:
    /// `axis` is a unit vector; 0 < tube ≤ radius. Lengths are world distances.
    Torus(Vec3 center, Vec3 axis, double radius, double tube);

    Vec3 center() const { return center_; }
    Vec3 axis() const { return axis_; }
    double radius() const { return radius_; }
    double tube() const { return tube_; }

    ValueGradient at(Vec3 x) const override;
    Range range(const Box& box) const override;
    Box bounding_box() const override;
    FieldPtr transformed_by(const Affine& map) const override;
    double last_sign_change_bound(Vec3 origin, Vec3 direction) const override;
    void begin_ray(FieldRay& ray) const override;
    double max_noise_scale(const Box& box) const override;
    ValueSlope at(const FieldRay& ray, double t) const override;
    RayBounds bounds(const FieldRay& ray, double t0, double t1) const override;

private:
    Vec3 center_, axis_;
    double radius_, tube_;
};

}  // namespace deburr
