// The cross-section of an edge where two planes meet, rounded in three ways [Lobb figure 5].
//
// The material is below: the wedge |x| ≤ −y tan(angle/2) of the dihedral `angle`, with its edge at the origin. The unit
// of length is the filter radius. Curves are given as y over x.
#pragma once
#include <functional>
#include <vector>

#include "bounds/local_density.hpp"

namespace deburr {

/// y of a curve as a function of x.
using SectionCurve = std::function<double(double x)>;

/// An edge and its rounded cross-sections.
class RoundedEdge {
public:
    /// `angle` is in radians, 0 < angle < π.
    explicit RoundedEdge(double angle);

    /// The two planes.
    double plane(double x) const;
    /// The surface of the product of the two smoothed half-spaces (quasi-convolution).
    double quasi(double x) const;
    /// The surface of the true convolution with a ball.
    double exact(double x) const;
    /// The circular arc that meets the planes where exact() does.
    double fillet(double x) const;

    /// The distance from the edge, along the planes, at which a curve leaves them: where a ball that is centred on one
    /// plane begins to meet the other plane (quasi_reach), or the other face, which ends at the edge (exact_reach).
    double quasi_reach() const { return 1 / std::sin(angle_); }
    double exact_reach() const { return angle_ < half_pi ? 1 / std::sin(angle_) : 1; }
    double fillet_radius() const { return exact_reach() * std::tan(angle_ / 2); }
    /// Half the width of the rounding: for |x| ≥ width() every curve lies in the planes.
    double width() const { return quasi_reach() * std::sin(angle_ / 2); }

private:
    static constexpr double half_pi = 1.57079632679489661923;
    double depth(const LocalDensity& density, double x) const;

    double angle_;
    LocalDensity quasi_, exact_;
};

/// The greatest distance of a point of either curve from the other curve, for |x| ≤ width; both curves must be even in
/// x. Curves are sampled at `steps` even steps in x.
double distance_between(const SectionCurve& a, const SectionCurve& b, double width, int steps);

/// Greatest distances between the three curves of an edge, in filter radii.
struct EdgeDistances {
    double quasi_exact, exact_fillet, quasi_fillet;
};
EdgeDistances distances(const RoundedEdge& edge, int steps = 400);

}  // namespace deburr
