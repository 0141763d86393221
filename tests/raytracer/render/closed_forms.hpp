// Closed forms that shading is held against, and directions at a surface whose normal is +z.
#pragma once
#include <cmath>

#include "bounds/vec.hpp"

namespace deburr {

inline const Vec3 up(0, 0, 1);

/// The unit vector at this cosine to +z; the azimuth is in radians from +x.
inline Vec3 at_cosine(double c, double azimuth = 0) {
    const double s = std::sqrt(1 - c * c);
    return {s * std::cos(azimuth), s * std::sin(azimuth), c};
}

/// Form factor of a rectangle at height 1 that has a corner straight above a parallel patch; its sides are a and b
/// [Howell's catalogue of configuration factors, B-3].
inline double corner_form_factor(double a, double b) {
    const double A = std::sqrt(1 + a * a), B = std::sqrt(1 + b * b);
    return (a / A * std::atan(b / A) + b / B * std::atan(a / B)) / (2 * pi);
}

}  // namespace deburr
