// M, L and G: bounds on a density along a ray segment [Lobb §3.4.1, after Kalra & Barr 1989].
#pragma once
#include "bounds/profile.hpp"

namespace deburr {

/// Value of a function at a point of a ray, and its derivative by the ray parameter t.
struct ValueSlope {
    double value = 0, slope = 0;
};

/// Bounds of a function ρ(t) on a segment of a ray.
struct RayBounds {
    double M = 0;  // |ρ| ≤ M
    double L = 0;  // |ρ′| ≤ L, per unit of t
    double G = 0;  // |ρ″| ≤ G, per unit of t²
};

/// Bounds of one half-space's density, whose α runs linearly from a0 to a1 over the segment; `rate` = |dα/dt|.
///
/// Printed differently: the paper's L lacks the division by r, which is in `rate` here; its G has |R·N| where the
/// derivative has |R·N|²; and α_max is capped at 1 here.
inline RayBounds half_space_bounds(double a0, double a1, double rate) {
    const double lo = a0 < a1 ? a0 : a1, hi = a0 < a1 ? a1 : a0;
    if (lo >= 1) return {};
    if (hi <= -1) return {1, 0, 0};
    const double nearest = lo > 0 ? lo : hi < 0 ? -hi : 0;
    const double farthest = std::min(1.0, std::max(-lo, hi));
    return {profile(lo), 0.75 * (1 - nearest * nearest) * rate, 1.5 * farthest * rate * rate};
}

/// Bounds of sums, differences, products and complements from those of the operands. `operands_positive` and
/// `operand_positive` say that no operand is ever negative.
///
/// Printed differently: M(ρ₁ + ρ₂) = min(1, …) and M(ρ₁ − ρ₂) = M(ρ₁) hold for legal densities only; the bounds below
/// hold for all.
inline RayBounds sum_bounds(const RayBounds& a, const RayBounds& b) { return {a.M + b.M, a.L + b.L, a.G + b.G}; }
inline RayBounds difference_bounds(const RayBounds& a, const RayBounds& b, bool operands_positive) {
    return {operands_positive ? std::max(a.M, b.M) : a.M + b.M, a.L + b.L, a.G + b.G};
}
inline RayBounds product_bounds(const RayBounds& a, const RayBounds& b) {
    return {a.M * b.M, a.M * b.L + b.M * a.L, a.M * b.G + b.M * a.G + 2 * a.L * b.L};
}
inline RayBounds complement_bounds(const RayBounds& a, bool operand_positive) {
    return {operand_positive ? std::max(1.0, a.M - 1) : 1 + a.M, a.L, a.G};
}

}  // namespace deburr
