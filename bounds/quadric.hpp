// Quadrics Q(x) ≥ 0: what Vyatkin's free forms and their perturbations are made of [Vyatkin eq. 1].
#pragma once
#include "bounds/box_range.hpp"
#include "bounds/vec.hpp"

namespace deburr {

/// Q(x) = yᵀAy + b·y + k, where y = x − center and A is symmetric; inside where Q > 0.
/// Printed differently: eq. 1 has no centre. It lets a quadric be moved without the rounding that
/// expanded coefficients suffer far from the origin.
struct Quadric {
    Vec3 center{0.0};
    Mat3 A{0.0};
    Vec3 b{0.0};
    double k = 0;

    double at(Vec3 x) const { return value(x - center); }
    Vec3 gradient(Vec3 x) const { return 2.0 * (A * (x - center)) + b; }
    /// Largest absolute value of a coefficient.
    double largest() const;
    /// Whether Q is the same everywhere: there is no surface.
    bool is_constant() const { return A == Mat3(0.0) && b == Vec3(0.0); }
    /// Sum of the absolute values of Q's terms, where |y| ≤ reach: Q is rounded by a few ε of
    /// this sum.
    double magnitude(Vec3 reach) const;
    /// Q over the box, rounding included; sides may be infinite.
    Range range(const Box& box) const;
    /// Q over all of space, but for rounding exact: what is within rounding of 0 is 0.
    Range range_everywhere() const;
    /// Holds the set Q > 0; exact for ellipsoids, and for what is infinite along axes. Where a set
    /// is infinite at a slant, all of space.
    Box bounding_box() const;

    /// A box of the size that the coefficients speak of, around the centre; for an infinite set, where
    /// its shape is to be seen.
    Box extent() const;

    Quadric scaled(double by) const { return {center, by * A, by * b, by * k}; }

private:
    double value(Vec3 y) const { return glm::dot(y, A * y + b) + k; }
};

/// x ↦ Q(M⁻¹x).
Quadric transformed(const Quadric& q, const Affine& map);

/// The ten coefficients of eq. 1, in its order: x² y² z² xy xz yz x y z 1.
Quadric quadric_from(const double (&coefficients)[10]);

/// Quadrics of revolution, as functions of the distance along the axis and the squared distance from it:
/// Q = k + along·t + along²·t² + across·ρ², where t is in units of `height` and ρ in units of `radius`.
struct Revolution {
    double constant = 0, along = 0, along_squared = 0, across_squared = -1;
};
Quadric revolved(const Revolution& revolution, Vec3 center, Vec3 axis, double radius, double height);

/// a·t + b·t² for t in [lo, hi], whose ends may be infinite.
Range parabola_range(double a, double b, double lo, double hi);

}  // namespace deburr
