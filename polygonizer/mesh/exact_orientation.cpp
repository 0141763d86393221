#include "polygonizer/mesh/exact_orientation.hpp"

#include <array>

namespace deburr {
namespace {

// A rounded value and its rounding error: value + rest is exact.
struct Exact {
    double value, rest;
};

Exact sum(double a, double b) {
    const double value = a + b, from_b = value - a, from_a = value - from_b;
    return {value, (a - from_a) + (b - from_b)};
}

Exact product(double a, double b) {
    const double value = a * b;
    return {value, std::fma(a, b, -value)};
}

// An exact sum as doubles that do not overlap, the greatest last.
template <std::size_t most>
class Expansion {
public:
    void add(double x) {
        std::size_t kept = 0;
        for (std::size_t k = 0; k < size_; ++k) {
            const Exact s = sum(x, terms_[k]);
            x = s.value;
            if (s.rest != 0) terms_[kept++] = s.rest;
        }
        if (x != 0) terms_[kept++] = x;
        size_ = kept;
    }
    void add_product(double a, double b) {
        const Exact p = product(a, b);
        add(p.rest);
        add(p.value);
    }
    void add_product(double a, double b, double c) {
        if (a == 0 || b == 0 || c == 0) return;
        const Exact p = product(a, b);
        add_product(p.rest, c);
        add_product(p.value, c);
    }
    // The greatest term, which has the sign of the sum.
    double leading() const { return size_ > 0 ? terms_[size_ - 1] : 0; }

private:
    std::array<double, most> terms_;
    std::size_t size_ = 0;
};

// With unit roundoff u each difference is off by a factor of 1 + u, and each product and sum by one more; so are the
// sums of absolute values that they are compared with. The few u beyond first order cover products of these.
constexpr double roundoff = epsilon / 2;
constexpr double plane_slack = 4 * roundoff, space_slack = 10 * roundoff;

}  // namespace

double orientation(Vec2 a, Vec2 b, Vec2 c) {
    const double left = (a.x - c.x) * (b.y - c.y), right = (a.y - c.y) * (b.x - c.x);
    const double twice = left - right;
    if (std::abs(twice) > plane_slack * (std::abs(left) + std::abs(right))) return twice;
    if (left == 0 && right == 0) return 0;
    Expansion<12> exact;
    exact.add_product(a.x, b.y);
    exact.add_product(-a.y, b.x);
    exact.add_product(b.x, c.y);
    exact.add_product(-b.y, c.x);
    exact.add_product(c.x, a.y);
    exact.add_product(-c.y, a.x);
    return exact.leading();
}

double orientation(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
    const Vec3 u = d - a, v = d - b, w = d - c;
    const double six = u.x * (v.y * w.z - v.z * w.y) + u.y * (v.z * w.x - v.x * w.z) + u.z * (v.x * w.y - v.y * w.x);
    const double size = std::abs(u.x) * (std::abs(v.y * w.z) + std::abs(v.z * w.y)) +
                        std::abs(u.y) * (std::abs(v.z * w.x) + std::abs(v.x * w.z)) +
                        std::abs(u.z) * (std::abs(v.x * w.y) + std::abs(v.y * w.x));
    if (std::abs(six) > space_slack * size) return six;
    if (size == 0) return 0;
    // Each difference is exact in two doubles, so the determinant is a sum of 6 · 2³ products of three doubles.
    std::array<std::array<Exact, 3>, 3> rows;
    const std::array<Vec3, 3> from{a, b, c};
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) rows[i][k] = sum(d[k], -from[i][k]);
    Expansion<192> exact;
    for (std::size_t k = 0; k < 3; ++k)
        for (const bool odd : {false, true}) {
            const Exact &x = rows[0][k], &y = rows[1][(k + (odd ? 2 : 1)) % 3], &z = rows[2][(k + (odd ? 1 : 2)) % 3];
            const double sign = odd ? -1 : 1;
            for (const double p : {x.value, x.rest})
                for (const double q : {y.value, y.rest})
                    for (const double r : {z.value, z.rest}) exact.add_product(sign * p, q, r);
        }
    return exact.leading();
}

}  // namespace deburr
