// Half-spaces of convex bodies that a scene gives by points.
//
// Points that span no volume throw std::runtime_error. Results depend on the set of points only, not on their order;
// faces parallel to an axis are exact.
#pragma once
#include <vector>

#include "bounds/vec.hpp"

namespace deburr {

/// n·x ≤ d, n unit and outward.
struct HullFace {
    Vec3 normal;
    double offset;
};

/// The convex hull (by qhull); faces in one plane are one half-space.
std::vector<HullFace> convex_hull(std::vector<Vec3> points);

}  // namespace deburr
