// Derivation of min_turning_distance(): the least time to a turning point beyond a root for |f′| ≤ L and |f″| ≤ G. The
// problem is mirrored so that f > 0 at the start, where the slope is s (s > 0: away from the root). The quickest way to
// reach f = 0 and then f′ = 0 is to accelerate towards the root with f″ = −G, and to brake with f″ = +G so that f′ = 0
// just after the root. As the root may be passed at any small speed, the bound is the time to come to rest at f = 0:
//   - accelerating from s to −w and braking to 0 covers f = w²/G − s²/2G, so w = √(Gf + s²/2),
//     and takes (s + w)/G + w/G;
//   - if s < 0 already and braking at once stops beyond the root (s² ≥ 2Gf), it takes −s/G;
//   - if w > L, the speed stays at L for part of the way, (f + s²/2G − L²/G)/L longer.
#include "bounds/root_finder.hpp"

#include <algorithm>
#include <cmath>

#include "bounds/field.hpp"

namespace deburr {

double min_turning_distance(SegmentEnd end, RayBounds bounds) {
    const auto [M, L, G] = bounds;
    const double f = std::abs(end.f);
    // At f = 0 the root is at the start itself: any slope leads beyond it.
    const double s = end.f > 0 ? end.slope : end.f < 0 ? -end.slope : -std::abs(end.slope);
    if (!(L > 0)) return infinity;  // f is constant
    if (!(G > 0)) return infinity;  // f is straight: no turning point
    if (s < 0 && s * s >= 2 * G * f) return -s / G;
    const double w = std::sqrt(G * f + 0.5 * s * s);
    if (w <= L) return (s + 2 * w) / G;
    return (s + 2 * L) / G + (f + s * s / (2 * G) - L * L / G) / L;
}

double lobb_turning_distance(SegmentEnd end, RayBounds bounds) {
    const auto [M, L, G] = bounds;
    if (!(L > 0) || !(G > 0)) return infinity;
    const double slope = std::abs(end.slope);
    const double turn_around = (end.f > 0) == (end.slope > 0) ? 2 * slope / G : 0.0;
    return std::max(std::abs(end.f) / L, slope / G) + turn_around;
}

bool at_most_one_root(SegmentEnd start, SegmentEnd end, RayBounds bounds, double length, Criterion criterion) {
    const auto distance = criterion == Criterion::exact ? min_turning_distance : lobb_turning_distance;
    return distance(start, bounds) + distance(end, bounds) > length;
}

// Regula falsi, with a bisection after every step that did not halve the bracket [a, b].
template <class OnRay>
double RootFinder::root(const OnRay& function, Point a, Point b) {
    const double sign = b.f > 0 ? 1 : -1;  // f·sign rises through 0 from a to b
    while (b.t - a.t > settings_.t_tolerance) {
        const double length = b.t - a.t;
        double t = a.t - a.f * (length / (b.f - a.f));
        for (int step = 0; step < 2; ++step) {
            // t is kept off the ends by a little, so that a root beside one of them is soon bracketed.
            t = std::clamp(t, a.t + 0.5 * settings_.t_tolerance, b.t - 0.5 * settings_.t_tolerance);
            if (!(t > a.t && t < b.t)) return b.t;
            const Point p = evaluate(function, t);
            if (p.f == 0) return p.t;
            (p.f * sign > 0 ? b : a) = p;
            if (b.t - a.t <= 0.5 * length) break;
            t = a.t + 0.5 * (b.t - a.t);
        }
    }
    return a.f == b.f ? b.t : a.t - a.f * ((b.t - a.t) / (b.f - a.f));
}

template double RootFinder::root(const RayDensity&, Point, Point);
template double RootFinder::root(const FieldRay&, Point, Point);

}  // namespace deburr
