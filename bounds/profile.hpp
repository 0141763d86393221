// Density of one smoothed half-space across its plane, and the inverse [Lobb eq. 2, §3.3].
//
//   α  signed distance outward from the plane, in filter radii
//   ρ  share of a ball's volume on the inner side, in [0, 1]
#pragma once
#include <algorithm>
#include <limits>

namespace deburr {

/// ρ(α): 1 for α ≤ −1, 0 for α ≥ 1, monotone between. α may be ±infinity, not NaN.
inline double profile(double alpha) {
    const double a = std::clamp(alpha, -1.0, 1.0);
    return (1 - a) * (1 - a) * (2 + a) * 0.25;
}

/// dρ/dα = −¾(1 − α²); 0 outside [−1, 1].
inline double profile_slope(double alpha) {
    const double a = std::clamp(alpha, -1.0, 1.0);
    return -0.75 * (1 - a) * (1 + a);
}

/// α where ρ(α) = rho: the root of α³ − 3α + (2 − 4ρ) in [−1, 1]. Falls monotonically from
/// 1 at ρ = 0 to −1 at ρ = 1; ½ gives exactly 0. Values outside [0, 1] give the nearer end.
double displacement(double rho);

/// |profile(displacement(ρ)) − ρ| is less than this; bound planes are displaced by so much more in ρ.
constexpr double inverse_slack = 8 * std::numeric_limits<double>::epsilon();

}  // namespace deburr
