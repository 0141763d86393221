// Bounds of how fast the share of a ball in a closed mesh can change, triangle by triangle [docs/design.md, Closed
// meshes].
#pragma once
#include <algorithm>
#include <cmath>

#include "bounds/vec.hpp"

namespace deburr {

// What one triangle contributes to bounds on the share's derivatives, with lengths in radii, as upper bounds over a
// range of plane distances |h|.
struct Steepness {
    double area = 0;    // |D|
    double across = 0;  // |h| φ, with φ as in `arcs`
    double along = 0;   // length of the sum of the unit vectors along the arcs that bound D
    double arcs = 0;    // φ, the angle of the arcs that bound D
};

/// `area` and `perimeter` are the triangle's; |h| is in [least_h, greatest_h]; `may_be_cut` says whether the sphere may
/// cut the triangle. Lengths are in radii.
inline Steepness steepness(double area, double perimeter, double least_h, double greatest_h, bool may_be_cut) {
    if (least_h >= 1) return {};
    const double widest = 1 - least_h * least_h, h = std::min(greatest_h, 1.0), narrowest = std::sqrt(1 - h * h);
    Steepness s;
    s.area = std::min(area, pi * widest);
    if (!may_be_cut) return s;
    // The arcs in a triangle are no longer than its border.
    s.arcs = perimeter < 2 * pi * narrowest ? perimeter / narrowest : 2 * pi;
    s.across = h * s.arcs;
    s.along = std::min(2 * std::sqrt(widest), perimeter);
    return s;
}

}  // namespace deburr
