// Roots of f(t) = ρ(o + t·d) − ½ on a ray segment. For a field (field.hpp) f is the field itself.
//
// A segment is halved until it provably holds at most one root [Lobb §3.4.2, after Kalra & Barr
// 1989]; the signs at its ends then tell whether it holds one, and regula falsi with interleaved
// bisection finds it [Lobb figure 9]. What cannot be proved is cut again, until the pieces are
// negligibly short.
//
//   t      ray parameter: a world distance where |d| = 1
//   f      dimensionless; a field's f is in the unit that the field chose for the ray
//   slope  f′ per unit of t, pointing *into* the segment at either end
#pragma once
#include <cmath>
#include <cstdint>

#include "bounds/local_density.hpp"

namespace deburr {

/// How it is proved that a segment holds at most one root.
enum class Criterion {
    exact,  // the least time to a turning point beyond a root, over all functions within the bounds
    lobb    // eq. 6, turn-around distance; unsound, kept to reproduce the paper
};

/// f at one end of a segment, and its slope f′ pointing into the segment.
struct SegmentEnd {
    double f, slope;
};

/// Least distance from `end` to a turning point of f beyond a root, over every f with |f′| ≤ L and
/// |f″| ≤ G; infinity where there can be none.
/// Printed differently: for f = 0⁺ and slope > 0 eq. 6 claims 3|ρ′|/G, where (1 + √2)|ρ′|/G can be reached; it
/// therefore accepts segments that hold two roots.
double min_turning_distance(SegmentEnd end, RayBounds bounds);

/// The value that the paper's eq. 6 claims for that distance, turn-around distance included; it may be too large.
double lobb_turning_distance(SegmentEnd end, RayBounds bounds);

/// True only if a segment of this length provably holds at most one root (with Criterion::exact); false says nothing.
bool at_most_one_root(SegmentEnd start, SegmentEnd end, RayBounds bounds, double length,
                      Criterion criterion = Criterion::exact);

/// What a search has cost: segments that were looked at, segments that were halved, and evaluations of f.
struct RootCounters {
    std::uint64_t segments = 0, splits = 0, evaluations = 0;
};

struct RootSettings {
    Criterion criterion = Criterion::exact;
    double t_tolerance = 1e-14;  // in t: a shorter segment is not halved, and roots are found to within it
    double f_tolerance = 1e-9;   // f counts as 0 where |f| provably stays below twice this
};

/// True only if |f| provably stays below 2 · `f_tolerance` throughout the segment. In the plane of a flush face f is 0
/// but for rounding while the half-spaces beside it vary, so nothing else would end the search there. The tolerance is
/// chosen: with the default a ray may cross the surface and come back unnoticed if it gets no deeper than 10⁻⁹ r, over
/// a length of some 3·10⁻⁵ r.
inline bool is_near_zero(SegmentEnd start, SegmentEnd end, RayBounds bounds, double length, double f_tolerance) {
    // f differs from the chord between the ends by G·length²/8 at most.
    return std::abs(start.f) <= f_tolerance && std::abs(end.f) <= f_tolerance &&
           bounds.G * length * length <= 8 * f_tolerance;
}

/// A crossing of the surface at ray parameter t.
struct RootCrossing {
    double t;
    bool entering;  // f > 0 beyond t
};

/// Finds roots on rays. `counters` must outlive the finder; every search adds to it.
class RootFinder {
public:
    RootFinder(RootSettings settings, RootCounters& counters) : settings_(settings), counters_(counters) {}

    /// Finds all crossings of the surface's level in [t0, t1] and calls visit(RootCrossing) for each in order of t; the
    /// search ends early where that returns false, and crossings() then returns false. OnRay is a RayDensity or a
    /// FieldRay. Sharp half-spaces of a RayDensity count as constant: on the side where fix_sharp() put them.
    template <class OnRay, class Visit>
    bool crossings(const OnRay& function, double t0, double t1, Visit&& visit);

    // |f| up to this counts as 0, which is outside: rounding makes up to an ε of error for each of the few factors and
    // terms of a density.
    static constexpr double rounding = 32 * epsilon;

private:
    struct Point {
        double t, f, slope;
    };
    template <class OnRay>
    Point evaluate(const OnRay& function, double t) {
        ++counters_.evaluations;
        const ValueSlope v = function.at(t);
        const double f = v.value - OnRay::level;
        return {t, std::abs(f) <= rounding ? 0 : f, v.slope};
    }
    template <class OnRay>
    double root(const OnRay& function, Point a, Point b);

    RootSettings settings_;
    RootCounters& counters_;
};

template <class OnRay, class Visit>
bool RootFinder::crossings(const OnRay& function, double t0, double t1, Visit&& visit) {
    // Depth first, the nearer half first. Halving a double's range ends long before the stack is full.
    Point stack[1100];
    int top = 0;
    Point a = evaluate(function, t0);
    stack[top++] = evaluate(function, t1);
    while (top > 0) {
        const Point b = stack[top - 1];
        const double length = b.t - a.t;
        ++counters_.segments;
        bool done = length <= settings_.t_tolerance || top >= 1099;
        if (!done) {
            const SegmentEnd start{a.f, a.slope}, end{b.f, -b.slope};
            const RayBounds bounds = function.bounds(a.t, b.t);
            done = at_most_one_root(start, end, bounds, length, settings_.criterion) ||
                   is_near_zero(start, end, bounds, length, settings_.f_tolerance);
        }
        if (!done) {
            const double middle = a.t + 0.5 * length;
            if (middle > a.t && middle < b.t) {
                ++counters_.splits;
                stack[top++] = evaluate(function, middle);
                continue;
            }
        }
        if ((a.f > 0) != (b.f > 0) && !visit(RootCrossing{root(function, a, b), b.f > 0})) return false;
        a = b;
        --top;
    }
    return true;
}

}  // namespace deburr
