// Quadrics {x : Q(x) > 0}, of which Vyatkin's free forms and perturbations are made [Vyatkin eq. 1].
#pragma once
#include "bounds/box_range.hpp"
#include "bounds/vec.hpp"

namespace deburr {

/// The rounding error of a quadric, a sum of some ten products, is less than this fraction of its magnitude; of its
/// cube three times as much.
constexpr double quadric_rounding = 16 * epsilon;

/// Q(x) = yᵀAy + b·y + k, where y = x − center and A is symmetric; the set is Q > 0. Printed differently: eq. 1 has no
/// centre. With one a quadric can be moved without the rounding error that expanded coefficients have far from the
/// origin.
struct Quadric {
    Vec3 center{0.0};
    Mat3 A{0.0};
    Vec3 b{0.0};
    double k = 0;

    /// Q and ∇Q at x.
    double at(Vec3 x) const { return value(x - center); }
    Vec3 gradient(Vec3 x) const { return 2.0 * (A * (x - center)) + b; }
    /// The largest absolute value of the coefficients A, b and k.
    double largest() const;
    /// Whether Q is the same everywhere, so that there is no surface.
    bool is_constant() const { return A == Mat3(0.0) && b == Vec3(0.0); }
    /// An upper bound of the sum of the absolute values of Q's terms for |y| ≤ reach (coordinate by coordinate). The
    /// rounding error of Q is a few ε of it.
    double magnitude(Vec3 reach) const;
    /// A range that holds Q over the box, rounding errors included; sides may be infinite.
    Range range(const Box& box) const;
    /// Range of Q over all of space, exact up to rounding; ends that are within rounding of 0 are 0.
    Range range_everywhere() const;
    /// A box that holds the set Q > 0. It is exact for ellipsoids and for sets that are infinite along coordinate axes
    /// only; where a set is infinite at a slant, it is all of space.
    Box bounding_box() const;

    /// A box around the centre of the size that the coefficients suggest; in an infinite set its shape shows there.
    Box extent() const;

    Quadric scaled(double by) const { return {center, by * A, by * b, by * k}; }

private:
    double value(Vec3 y) const { return glm::dot(y, A * y + b) + k; }
};

/// The quadric x ↦ Q(M⁻¹x); `map` must be regular.
Quadric transformed(const Quadric& q, const Affine& map);

/// The quadric with the ten coefficients of eq. 1, in its order: x² y² z² xy xz yz x y z 1.
Quadric quadric_from(const double (&coefficients)[10]);

/// Coefficients of a quadric of revolution, as a function of the height t along the axis, in units of `height`, and the
/// distance ρ from the axis, in units of `radius`: Q = constant + along·t + along_squared·t² + across_squared·ρ².
struct Revolution {
    double constant = 0, along = 0, along_squared = 0, across_squared = -1;
};
/// The quadric of revolution about the unit vector `axis` through `center`.
Quadric revolved(const Revolution& revolution, Vec3 center, Vec3 axis, double radius, double height);

/// Range of a·t + b·t² for t in [lo, hi], whose ends may be infinite.
Range parabola_range(double a, double b, double lo, double hi);

}  // namespace deburr
