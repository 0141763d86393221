// Half-spaces of convex bodies given by points.
//
// Points that span no volume throw std::runtime_error. The result depends only on the set of points, not on their
// order; faces parallel to an axis are exact.
#pragma once
#include <vector>

#include "bounds/vec.hpp"

namespace deburr {

/// A half-space n·x ≤ offset with a unit normal that points outward.
struct HullFace {
    Vec3 normal;
    double offset;
};

/// The faces of the convex hull (by qhull); facets in one plane are one face.
std::vector<HullFace> convex_hull(std::vector<Vec3> points);

}  // namespace deburr
