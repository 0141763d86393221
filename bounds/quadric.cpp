#include "bounds/quadric.hpp"

#include <algorithm>

namespace deburr {
namespace {

// The products of values of a and of b, which may be infinite; 0 times infinity is 0.
Range extended_product(Range a, Range b) {
    const auto times = [](double x, double y) { return x == 0 || y == 0 ? 0.0 : x * y; };
    const auto [lo, hi] = std::minmax({times(a.lo, b.lo), times(a.lo, b.hi), times(a.hi, b.lo), times(a.hi, b.hi)});
    return {lo, hi};
}

}  // namespace

Range parabola_range(double a, double b, double lo, double hi) {
    const auto at = [&](double t) {
        if (std::isfinite(t)) return t * (a + b * t);
        if (b != 0) return b > 0 ? infinity : -infinity;
        return a == 0 ? 0.0 : a * t;
    };
    Range r{std::min(at(lo), at(hi)), std::max(at(lo), at(hi))};
    if (b != 0) {
        const double vertex = -a / (2 * b);
        if (vertex > lo && vertex < hi) {
            const double v = at(vertex);
            r.lo = std::min(r.lo, v);
            r.hi = std::max(r.hi, v);
        }
    }
    return r;
}

double Quadric::largest() const {
    double most = std::abs(k);
    for (int i = 0; i < 3; ++i) {
        most = std::max(most, std::abs(b[i]));
        for (int j = 0; j < 3; ++j) most = std::max(most, std::abs(A[i][j]));
    }
    return most;
}

double Quadric::magnitude(Vec3 reach) const {
    double sum = std::abs(k);
    for (int i = 0; i < 3; ++i) {
        if (b[i] != 0) sum += std::abs(b[i]) * reach[i];
        for (int j = 0; j < 3; ++j)
            if (A[i][j] != 0) sum += std::abs(A[i][j]) * reach[i] * reach[j];
    }
    return sum;
}

Range Quadric::range(const Box& box) const {
    if (!box.finite()) {  // about the centre, axis by axis
        const Vec3 lo = box.lo - center, hi = box.hi - center;
        Range sum{k, k};
        double reach = std::abs(k);
        for (int i = 0; i < 3; ++i) {
            const Range own = parabola_range(b[i], A[i][i], lo[i], hi[i]);
            sum = {sum.lo + own.lo, sum.hi + own.hi};
            for (const double part : {own.lo, own.hi})
                if (std::isfinite(part)) reach += std::abs(part);
            for (int j = 0; j < i; ++j) {
                if (A[i][j] == 0) continue;
                const Range both = extended_product({lo[i], hi[i]}, {lo[j], hi[j]});
                const double c = 2 * A[i][j];
                sum = {sum.lo + c * (c > 0 ? both.lo : both.hi), sum.hi + c * (c > 0 ? both.hi : both.lo)};
            }
        }
        if (!(sum.lo <= sum.hi)) return {-infinity, infinity};  // ∞ − ∞
        return {sum.lo - quadric_rounding * reach, sum.hi + quadric_rounding * reach};
    }
    const Vec3 half = 0.5 * (box.hi - box.lo), y = box.lo + half - center;
    const Vec3 slope = 2.0 * (A * y) + b;
    const double middle = value(y);
    Range sum{middle, middle};
    for (int i = 0; i < 3; ++i) {
        const Range own = parabola_range(slope[i], A[i][i], -half[i], half[i]);
        sum = {sum.lo + own.lo, sum.hi + own.hi};
        for (int j = 0; j < i; ++j) {
            const double both = 2 * std::abs(A[i][j]) * half[i] * half[j];
            sum = {sum.lo - both, sum.hi + both};
        }
    }
    const double off = quadric_rounding * magnitude(glm::abs(y) + half);
    return {sum.lo - off, sum.hi + off};
}

// Along the eigenvectors of A the variables separate.
Range Quadric::range_everywhere() const {
    const auto [axes, squares] = eigensystem(A);
    const auto rounded = [](double value, double size) {
        return std::abs(value) <= quadric_rounding * size ? 0.0 : value;
    };
    Range sum{k, k};
    double size = std::abs(k);
    for (int i = 0; i < 3; ++i) {
        const double square = rounded(squares[i], deburr::largest(squares)),
                     linear = rounded(glm::dot(axes[i], b), deburr::largest(b));
        const Range own = parabola_range(linear, square, -infinity, infinity);
        sum = {sum.lo + own.lo, sum.hi + own.hi};
        if (square != 0) size += std::abs(linear * linear / (4 * square));
    }
    return {rounded(sum.lo, size), rounded(sum.hi, size)};
}

// Along an axis that A does not involve, Q is linear: it bounds the set on one side at most. Along the other axes the
// box is that of the set's widest cross-section, an ellipse (or ellipsoid, or interval).
Box Quadric::bounding_box() const {
    Box box = Box::everything();
    int straight = -1, free = 0;
    bool solid[3];
    for (int i = 0; i < 3; ++i) {
        solid[i] = A[i] != Vec3(0.0);
        if (solid[i]) continue;
        if (b[i] == 0) continue;
        straight = i;
        ++free;
    }
    if (free > 1) return box;
    // −A restricted to the axes that it involves; the others get 1 on the diagonal.
    Mat3 positive = -A;
    Vec3 linear = b;
    for (int i = 0; i < 3; ++i)
        if (!solid[i]) {
            positive[i][i] = 1;
            linear[i] = 0;
        }
    const double diagonal = positive[0][0] * positive[1][1] * positive[2][2];
    const double minor = positive[0][0] * positive[1][1] - positive[0][1] * positive[1][0];
    const double determinant = glm::determinant(positive);
    // A set that is infinite at a slant may come out of rounding as a huge finite one.
    constexpr double slenderest = 1e-12;  // of ellipsoids: square of the ratio of their radii
    if (!(positive[0][0] > 0 && minor > 0 && determinant > slenderest * diagonal)) return box;
    const Mat3 inverse = glm::inverse(positive);
    const Vec3 middle = 0.5 * (inverse * linear);
    const double top = k + 0.5 * glm::dot(linear, middle);  // the greatest value of Q
    if (straight >= 0) {
        const double end = center[straight] - top / b[straight];
        (b[straight] > 0 ? box.lo : box.hi)[straight] =
            end - quadric_rounding * (std::abs(end) + std::abs(center[straight]));
        return box;
    }
    const double off = quadric_rounding * (std::abs(k) + glm::dot(glm::abs(linear), glm::abs(middle)));
    if (top < -off) return {};
    const double wider = 1 + 4 * quadric_rounding * diagonal / determinant;
    for (int i = 0; i < 3; ++i) {
        if (!solid[i]) continue;
        const double half = std::sqrt((std::max(0.0, top) + off) * inverse[i][i]) * wider;
        const double rounding = quadric_rounding * (std::abs(center[i]) + std::abs(middle[i])) * wider;
        box.lo[i] = center[i] + middle[i] - half - rounding;
        box.hi[i] = center[i] + middle[i] + half + rounding;
    }
    return box;
}

Box Quadric::extent() const {
    double square = 0, linear = 0;
    for (int i = 0; i < 3; ++i) {
        linear = std::max(linear, std::abs(b[i]));
        for (int j = 0; j < 3; ++j) square = std::max(square, std::abs(A[i][j]));
    }
    double size = square > 0   ? std::max(std::sqrt(std::abs(k) / square), linear / square)
                  : linear > 0 ? std::abs(k) / linear
                               : 0;
    if (!(size > 0)) size = 1;  // a cone, or a plane through the centre: every size is the same
    return inflated({center, center}, 2 * size);
}

Quadric transformed(const Quadric& q, const Affine& map) {
    const Mat3 back = glm::inverse(map.linear), forward = glm::transpose(back);
    Mat3 A = forward * q.A * back;
    A = 0.5 * (A + glm::transpose(A));
    return {map(q.center), A, forward * q.b, q.k};
}

Quadric quadric_from(const double (&c)[10]) {
    const double xy = 0.5 * c[3], xz = 0.5 * c[4], yz = 0.5 * c[5];
    return {Vec3(0.0), Mat3(Vec3(c[0], xy, xz), Vec3(xy, c[1], yz), Vec3(xz, yz, c[2])), {c[6], c[7], c[8]}, c[9]};
}

Quadric revolved(const Revolution& revolution, Vec3 center, Vec3 axis, double radius, double height) {
    const Mat3 along = glm::outerProduct(axis, axis), across = Mat3(1.0) - along;
    return {center,
            (revolution.along_squared / (height * height)) * along +
                (revolution.across_squared / (radius * radius)) * across,
            (revolution.along / height) * axis, revolution.constant};
}

}  // namespace deburr
