// Vectors, affine maps and axis-parallel boxes, all in double precision (GLM).
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <numbers>

namespace deburr {

using Vec2 = glm::dvec2;
using Vec3 = glm::dvec3;
using Mat3 = glm::dmat3;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double pi = std::numbers::pi;

/// 1, −1, or 0 for 0.
constexpr int sign_of(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

/// Largest absolute value of the coordinates.
inline double largest(Vec3 v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// The least and the greatest coordinate. Signs count.
inline double min_component(Vec3 v) { return std::min({v.x, v.y, v.z}); }
inline double max_component(Vec3 v) { return std::max({v.x, v.y, v.z}); }

inline bool is_finite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
/// v, or 0 if any of its coordinates is infinite or a NaN.
inline Vec3 finite_or_zero(Vec3 v) { return is_finite(v) ? v : Vec3(0.0); }

/// Axis of the greatest coordinate, 0 to 2; the first of several that are equal. Signs count.
inline int greatest_axis(Vec3 v) { return v.x >= v.y && v.x >= v.z ? 0 : v.y >= v.z ? 1 : 2; }

/// Distance from x to the segment ab (a point if a = b).
template <glm::length_t N>
double distance_to_segment(const glm::vec<N, double>& x, const glm::vec<N, double>& a, const glm::vec<N, double>& b) {
    const glm::vec<N, double> d = b - a;
    const double square = glm::dot(d, d);
    const double s = square > 0 ? std::clamp(glm::dot(x - a, d) / square, 0.0, 1.0) : 0.0;
    return glm::distance(x, a + s * d);
}

/// The affine map x ↦ linear·x + shift.
struct Affine {
    Mat3 linear{1.0};
    Vec3 shift{0.0};

    Vec3 operator()(Vec3 x) const { return linear * x + shift; }
};

/// The map that applies `first`, then `then`.
inline Affine compose(const Affine& then, const Affine& first) {
    return {then.linear * first.linear, then(first.shift)};
}

/// The inverse map. It contains NaN or infinity if `map` is numerically singular.
inline Affine inverse(const Affine& map) {
    const Mat3 linear = glm::inverse(map.linear);
    return {linear, -(linear * map.shift)};
}

/// Eigenvalues of a symmetric matrix, and its eigenvectors as the columns of an orthonormal matrix, in the same order.
struct Eigensystem {
    Mat3 vectors;
    Vec3 values;
};
/// Eigendecomposition of a symmetric matrix, by Jacobi rotations.
Eigensystem eigensystem(Mat3 symmetric);

/// Axis-parallel box; sides may lie at ±infinity. It is empty where lo > hi on some axis, as a default-constructed box
/// is.
struct Box {
    Vec3 lo{infinity}, hi{-infinity};

    static Box everything() { return {Vec3(-infinity), Vec3(infinity)}; }
    /// Whether lo > hi on some axis. A box that is a point or a face is not empty.
    bool empty() const { return lo.x > hi.x || lo.y > hi.y || lo.z > hi.z; }
    /// The faces count as inside.
    bool contains(Vec3 x) const {
        return lo.x <= x.x && x.x <= hi.x && lo.y <= x.y && x.y <= hi.y && lo.z <= x.z && x.z <= hi.z;
    }
    bool finite() const {
        for (int k = 0; k < 3; ++k)
            if (!std::isfinite(lo[k]) || !std::isfinite(hi[k])) return false;
        return true;
    }
};

/// The least box that holds both.
inline Box hull(const Box& a, const Box& b) { return {glm::min(a.lo, b.lo), glm::max(a.hi, b.hi)}; }
inline Box intersection(const Box& a, const Box& b) { return {glm::max(a.lo, b.lo), glm::min(a.hi, b.hi)}; }
/// The box with every side moved outward by the length `by`, which may be negative.
inline Box inflated(const Box& b, double by) { return {b.lo - Vec3(by), b.hi + Vec3(by)}; }

/// Half the area of the box's surface; 0 if it is empty.
inline double half_area(const Box& b) {
    const Vec3 d = glm::max(b.hi - b.lo, Vec3(0.0));
    return d.x * d.y + d.y * d.z + d.z * d.x;
}

/// A box around the image of `box`, which must not be empty; rounding makes it larger, never smaller.
Box image(const Affine& map, const Box& box);

}  // namespace deburr
