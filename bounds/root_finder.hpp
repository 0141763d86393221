// Roots of f(t) = ρ(o + t·d) − ½ on a ray segment; of a field (field.hpp), of f itself.
//
// A segment is halved until it provably holds at most one root [Lobb §3.4.2, after Kalra & Barr
// 1989]; the signs at its ends then tell whether it holds one, and regula falsi with interleaved
// bisection finds it [Lobb figure 9]. What cannot be proved is cut again, until the pieces are
// negligibly short.
//
//   t      ray parameter: a world distance where |d| = 1
//   f      dimensionless
//   slope  f′ per unit of t, pointing *into* the segment at either end
#pragma once
#include <cmath>
#include <cstdint>

#include "bounds/local_density.hpp"

namespace deburr {

/// When a segment counts as holding at most one root.
enum class Criterion {
    exact,  // the least time to a turning point beyond a root, over all functions within the bounds
    lobb    // eq. 6, turn-around distance; unsound, for reproducing the paper
};

struct SegmentEnd {
    double f, slope;
};

/// Least distance from `end` to a turning point of f beyond a root, over every f with |f′| ≤ L and
/// |f″| ≤ G; infinity where there can be none.
/// Printed differently: for f = 0⁺ and slope > 0 eq. 6 claims 3|ρ′|/G where (1 + √2)|ρ′|/G is
/// enough, and so accepts segments that hold two roots.
double min_turning_distance(SegmentEnd end, RayBounds bounds);

/// The same distance as the paper's eq. 6 claims it, turn-around distance included.
double lobb_turning_distance(SegmentEnd end, RayBounds bounds);

/// Exact: true only if the segment provably holds at most one root; false says nothing.
bool at_most_one_root(SegmentEnd start, SegmentEnd end, RayBounds bounds, double length,
                      Criterion criterion = Criterion::exact);

struct RootCounters {
    std::uint64_t segments = 0, splits = 0, evaluations = 0;
};

struct RootSettings {
    Criterion criterion = Criterion::exact;
    double t_tolerance = 1e-14;  // a segment no longer than this is not cut again, and roots are
                                 // found to within it
    double f_tolerance = 1e-9;   // f counts as 0 where |f| provably stays below twice this
};

/// Exact: whether |f| stays below 2 · `f_tolerance` throughout. In the plane of a flush face f is 0 but for
/// rounding while the half-spaces beside it vary, so nothing else would end the search there. Chosen:
/// what is passed over is a ray's dip of 10⁻⁹ r, some 3·10⁻⁵ r long.
inline bool is_near_zero(SegmentEnd start, SegmentEnd end, RayBounds bounds, double length, double f_tolerance) {
    // Off the chord by G·length²/8 at most.
    return std::abs(start.f) <= f_tolerance && std::abs(end.f) <= f_tolerance &&
           bounds.G * length * length <= 8 * f_tolerance;
}

struct RootCrossing {
    double t;
    bool entering;  // f > 0 beyond it
};

class RootFinder {
public:
    RootFinder(RootSettings settings, RootCounters& counters) : settings_(settings), counters_(counters) {}

    /// All crossings of the surface's level in [t0, t1], in order; sharp half-spaces stay as fix_sharp
    /// left them. `visit(RootCrossing)` says whether to go on; false if it said no. OnRay is a RayDensity
    /// or a FieldRay.
    template <class OnRay, class Visit>
    bool crossings(const OnRay& function, double t0, double t1, Visit&& visit);

    // f = 0 is not inside, and what rounding makes of it must not be either: sums of a few products
    // of numbers in [0, 1] are off by an ε each.
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
    // Depth first, near half first. Halving a double's range ends long before the stack does.
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
