#include "bounds/polyhedron_box.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace deburr {
namespace {

// ---- linear programs in up to three variables ------------------------------------------------------

// The constraint a·x ≤ b. All numbers are scaled so that offsets are at most 1; |x| ≤ far stands for unbounded.
template <int D>
struct Constraint {
    std::array<double, D> a;
    double b;
};

constexpr double far = 1e6;
// A constraint counts as violated by more than this, with coordinates of size 1 and normals of length 1.
constexpr double feasible = 1e-11;

template <int D>
using Point = std::array<double, D>;

template <int D>
double dot(const std::array<double, D>& a, const std::array<double, D>& x) {
    double sum = 0;
    for (int k = 0; k < D; ++k) sum += a[k] * x[k];
    return sum;
}

// Maximizes c·x subject to the constraints and |x_k| ≤ far; false if they have no solution. `x` is the optimum.
template <int D>
bool maximize(const std::vector<Constraint<D>>& constraints, const std::array<double, D>& c, Point<D>& x) {
    for (int k = 0; k < D; ++k) x[k] = c[k] < 0 ? -far : far;
    for (std::size_t i = 0; i < constraints.size(); ++i) {
        const std::array<double, D>& a = constraints[i].a;  // no structured binding, because lambdas capture them
        const double b = constraints[i].b;
        double size = 1;
        for (int k = 0; k < D; ++k) size = std::max(size, std::abs(x[k]));
        if (dot<D>(a, x) <= b + feasible * size) continue;
        // The optimum lies on this plane: solve for its steepest coordinate, one variable fewer.
        int pivot = 0;
        for (int k = 1; k < D; ++k)
            if (std::abs(a[k]) > std::abs(a[pivot])) pivot = k;
        const double top = a[pivot];
        if (std::abs(top) < 1e-14) return false;
        if constexpr (D == 1) {
            x[0] = b / top;
            if (std::abs(x[0]) > far) return false;
            for (std::size_t j = 0; j < i; ++j) {
                const double room = constraints[j].b - constraints[j].a[0] * x[0];
                if (room < -feasible * std::max(1.0, std::abs(x[0]))) return false;
            }
        } else {
            const auto project = [&](const std::array<double, D>& from, double& offset) {
                std::array<double, D - 1> to{};
                const double share = from[pivot] / top;
                for (int k = 0, m = 0; k < D; ++k)
                    if (k != pivot) to[m++] = from[k] - share * a[k];
                offset -= share * b;
                return to;
            };
            std::vector<Constraint<D - 1>> lower;
            for (std::size_t j = 0; j < i; ++j) {
                double offset = constraints[j].b;
                const auto normal = project(constraints[j].a, offset);
                lower.push_back({normal, offset});
            }
            for (const double sign : {1.0, -1.0}) {  // |x_pivot| ≤ far
                std::array<double, D> side{};
                side[pivot] = sign;
                double offset = far;
                const auto normal = project(side, offset);
                lower.push_back({normal, offset});
            }
            double ignored = 0;
            const auto goal = project(c, ignored);
            Point<D - 1> y;
            if (!maximize<D - 1>(lower, goal, y)) return false;
            double rest = b;
            for (int k = 0, m = 0; k < D; ++k)
                if (k != pivot) {
                    x[k] = y[m];
                    rest -= a[k] * y[m++];
                }
            x[pivot] = rest / top;
        }
    }
    return true;
}

// A side of the box in the caller's units, rounded outward. An unbounded program ends at `far`, or near it after
// projections.
double side(double value, double sign, double scale) {
    if (sign * value > 0.5 * far) return sign * infinity;
    return (value + sign * 1e-9 * std::max(1.0, std::abs(value))) * scale;
}

bool is_along_axis(const Vec3& n) { return (n.x != 0) + (n.y != 0) + (n.z != 0) == 1; }

// polyhedron_box() for planes that are all perpendicular to an axis: the sides are read off.
Box axis_parallel_box(const std::vector<BoundPlane>& planes, double scale) {
    Vec3 lo(-far), hi(far);
    for (const BoundPlane& p : planes)
        for (int k = 0; k < 3; ++k) {
            if (p.normal[k] > 0) hi[k] = std::min(hi[k], p.offset / scale / p.normal[k]);
            if (p.normal[k] < 0) lo[k] = std::max(lo[k], p.offset / scale / p.normal[k]);
        }
    Box box;
    for (int k = 0; k < 3; ++k) {
        if (lo[k] - hi[k] > feasible) return {};
        box.lo[k] = side(lo[k], -1, scale);
        box.hi[k] = side(hi[k], 1, scale);
    }
    return box;
}

}  // namespace

Box polyhedron_box(const std::vector<BoundPlane>& planes) {
    double scale = 0;
    for (const BoundPlane& p : planes) scale = std::max(scale, std::abs(p.offset));
    if (!(scale > 0)) scale = 1;
    if (std::all_of(planes.begin(), planes.end(), [](const BoundPlane& p) { return is_along_axis(p.normal); }))
        return axis_parallel_box(planes, scale);
    std::vector<Constraint<3>> constraints;
    for (const BoundPlane& p : planes) constraints.push_back({{p.normal.x, p.normal.y, p.normal.z}, p.offset / scale});
    // A fixed pseudorandom order makes the expected time linear.
    std::uint64_t state = 1;
    for (std::size_t i = constraints.size(); i > 1; --i) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        std::swap(constraints[i - 1], constraints[(state >> 33) % i]);
    }
    Box box;
    for (int k = 0; k < 3; ++k)
        for (const double sign : {1.0, -1.0}) {
            std::array<double, 3> goal{};
            goal[k] = sign;
            Point<3> x;
            if (!maximize<3>(constraints, goal, x)) return {};
            (sign > 0 ? box.hi : box.lo)[k] = side(x[k], sign, scale);
        }
    return box;
}

GatheredBox intersect(GatheredBox a, GatheredBox b) {
    if (a.planes.size() < b.planes.size()) std::swap(a, b);
    a.planes.insert(a.planes.end(), b.planes.begin(), b.planes.end());
    a.rest = intersection(a.rest, b.rest);
    return a;
}

GatheredBox unite(const GatheredBox& a, const GatheredBox& b) { return {hull(a.box(), b.box()), {}}; }

}  // namespace deburr
