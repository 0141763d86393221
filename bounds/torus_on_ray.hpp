// Where a ray crosses a torus: the roots of
//
//     f = 4R²s² − (s² + h² + R² − a²)²
//
// a polynomial of degree four in u, the ray's parameter from the place that is nearest to the torus's center on. Roots
// are told apart by Descartes' rule of signs: a stretch of the ray has none if the polynomial's Bernstein coefficients
// over it are of one sign, and one if the sign changes once; else it is halved. A root is found by Newton's method
// within its stretch, with a last step on the distance from the tube's circle, which is known to within rounding where
// f has lost digits: f is as wrong as 4R²s², and as steep as 8aRs.
//
// Ferrari's closed form was not taken: it needs cube roots and cosines, which vectors have not to the same bits, and
// where two roots are near each other it loses half of the digits. Measured on 200,000 whole rays around a tube of
// 0.35 R it is off by 2·10⁻⁶ R at worst, this by 2·10⁻¹⁵, at 120 ns a ray and 175 for all roots; around one of 0.02 R,
// which most rays miss, at 120 ns and 70.
//
//   R, a    radii of the circle and of the tube, a ≤ R
//   s, h    distance from the axis, height along it
#pragma once
#include "bounds/convex_density.hpp"
#include "bounds/round_coordinate.hpp"

namespace deburr {

/// Crossings of a round surface, in order of t.
struct RoundCrossings {
    bool start_inside = false;
    int count = 0;
    ConvexCrossing at[4];
};

class TorusOnRay {
public:
    // Thinner tubes are lost in f's rounding.
    static constexpr double least_tube = 0x1p-12;  // of the circle's radius
    // The ray is looked at in a ball that is so much larger than the one around the torus.
    static constexpr double larger = 1 + 0x1p-20;
    // A root of f is near enough for a step on the distance, which squares how far it is off, in radii of the tube.
    static constexpr double near_enough = 0x1p-26;
    static constexpr int max_steps = 60;

    /// Along o + t·d, t0 ≤ t ≤ t1. Where f is 0 to within rounding is not in the torus, nor in its `complement`.
    TorusOnRay(const RoundCoordinate& circle, double tube, bool complement, const Vec3& o, const Vec3& d, double t0,
               double t1);
    RoundCrossings crossings() const;

private:
    double value(double u) const { return c0_ + u * (c1_ + u * (c2_ + u * (u * c4_))); }
    double slope(double u) const { return c1_ + u * (2 * c2_ + u * (4 * u * c4_)); }
    /// The root between, of which the value at `from` and at `to` tell.
    double root(double from, double to, double at_from, double at_to) const;
    double nearer_by_distance(double u) const;

    double ring_, tube_, t0_, t1_;
    bool complement_;
    double middle_, lo_, hi_;  // of u
    double c0_, c1_, c2_, c4_;
    double start_square_, start_rate_, rate_square_;  // s² = start_square + 2·start_rate·u + rate_square·u²
    double height_, climb_;
    double least_length_, tolerance_;
};

}  // namespace deburr
