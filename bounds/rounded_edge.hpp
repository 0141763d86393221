// The cross-section of an edge where two planes meet, rounded in three ways [Lobb figure 5].
//
// The material is below: the wedge |x| ≤ −y tan(angle/2) of the dihedral `angle`, its edge at the
// origin. The unit of length is the filter's radius. Curves are given as y over x.
#pragma once
#include <functional>
#include <vector>

#include "bounds/local_density.hpp"

namespace deburr {

using SectionCurve = std::function<double(double x)>;

class RoundedEdge {
public:
    /// 0 < angle < π, in radians.
    explicit RoundedEdge(double angle);

    double plane(double x) const;
    /// The product of the two smoothed half-spaces.
    double quasi(double x) const;
    /// The share of a ball.
    double exact(double x) const;
    /// The arc that meets the planes where `exact` does.
    double fillet(double x) const;

    /// How far from the edge the curves leave the planes, measured along these: where a ball that is
    /// centred on one plane begins to meet the other plane, and the other face.
    double quasi_reach() const { return 1 / std::sin(angle_); }
    double exact_reach() const { return angle_ < half_pi ? 1 / std::sin(angle_) : 1; }
    double fillet_radius() const { return exact_reach() * std::tan(angle_ / 2); }
    /// Half the width of the rounding: for larger |x| every curve lies in the planes.
    double width() const { return quasi_reach() * std::sin(angle_ / 2); }

private:
    static constexpr double half_pi = 1.57079632679489661923;
    double depth(const LocalDensity& density, double x) const;

    double angle_;
    LocalDensity quasi_, exact_;
};

/// The greatest distance of a point of either curve from the other curve, for |x| ≤ width, where the
/// curves are the same for −x; off by what `steps` even steps in x miss.
double distance_between(const SectionCurve& a, const SectionCurve& b, double width, int steps);

struct EdgeDistances {
    double quasi_exact, exact_fillet, quasi_fillet;
};
EdgeDistances distances(const RoundedEdge& edge, int steps = 400);

}  // namespace deburr
