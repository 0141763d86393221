// Printed differently: Lobb §3.3 gives α = 2 cos((arccos(2ρ − 1) + 4π)/3). Rounding takes that out
// of [−1, 1] near both ends, and near ρ = ½ it is off by several ε. With s = 2ρ − 1 and
// θ = arcsin(s)/3 the same root is α = −2 sin θ: odd in s, exact at ½. Near the ends arcsin loses
// half of its digits, so there the root is taken by Newton's method from the double root's
// expansion: with u = 1 − |α| the smaller of ρ and 1 − ρ is u²(3 − u)/4.
#include "bounds/profile.hpp"

#include <cmath>

namespace deburr {
namespace {

// Root u in [0, 1] of u²(3 − u)/4 = q, for q in [0, ½]. Newton's method from above the root falls monotonically,
// because u²(3 − u) is convex on [0, 1]; the start √(4q/3) lies below the root, and one step carries it above.
double cap_height(double q) {
    double u = std::sqrt(q * (4.0 / 3.0));
    for (int step = 0; step < 5; ++step) {
        const double slope = u * (2 - u) * 0.75;
        if (slope <= 0) break;
        u -= (u * u * (3 - u) * 0.25 - q) / slope;
    }
    return std::clamp(u, 0.0, 1.0);
}

}  // namespace

double displacement(double rho) {
    if (!(rho > 0)) return 1;
    if (rho >= 1) return -1;
    constexpr double end = 0.05;  // below it arcsin's error exceeds that of Newton's method
    if (rho < end) return 1 - cap_height(rho);
    if (rho > 1 - end) return cap_height(1 - rho) - 1;
    return -2 * std::sin(std::asin(2 * rho - 1) / 3);
}

}  // namespace deburr
