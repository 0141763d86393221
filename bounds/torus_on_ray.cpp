#include "bounds/torus_on_ray.hpp"

#include <algorithm>

#include "bounds/root_finder.hpp"

namespace deburr {

// Every step is repeated for vectors in raytracer/simd/torus_packet-inl.hpp, operation by operation.

TorusOnRay::TorusOnRay(const RoundCoordinate& circle, double tube, bool complement, const Vec3& o, const Vec3& d,
                       double t0, double t1)
    : ring_(circle.ring), tube_(tube), t0_(t0), t1_(t1), complement_(complement) {
    const Vec3 away = o - circle.center;
    const double speed = glm::dot(d, d);
    middle_ = -glm::dot(away, d) / speed;
    const Vec3 y = away + middle_ * d;
    height_ = glm::dot(circle.axis, y);
    climb_ = glm::dot(circle.axis, d);
    const Vec3 across = y - circle.axis * height_, rate = d - circle.axis * climb_;
    start_square_ = glm::dot(across, across);
    start_rate_ = glm::dot(across, rate);
    rate_square_ = glm::dot(rate, rate);

    const double R = ring_, reach = (R + tube_) * larger, square = glm::dot(y, y);
    const double half = std::sqrt(std::max(reach * reach - square, 0.0) / speed);
    lo_ = std::max(t0 - middle_, -half);
    hi_ = std::min(t1 - middle_, half);
    const double k = square + (R - tube_) * (R + tube_), four = 4 * R * R;
    const double noise = RootFinder::rounding * (2 * four * (reach * reach));
    c0_ = four * start_square_ - k * k - (complement ? -noise : noise);
    c1_ = 2 * four * start_rate_;
    c2_ = four * rate_square_ - 2 * k * speed;
    c4_ = -(speed * speed);
    least_length_ = 16 * epsilon * (half + std::abs(middle_));
    tolerance_ = near_enough * tube_ / std::sqrt(speed);
}

RoundCrossings TorusOnRay::crossings() const {
    RoundCrossings found;
    double from = lo_, width = hi_ - lo_, at_from = value(lo_);
    bool in = lo_ < hi_ && at_from > 0;
    found.start_inside = in != complement_;
    while (from < hi_) {
        const double to = std::min(from + width, hi_), length = to - from, at_to = value(to);
        // The Bernstein coefficients of f on the segment, from its Taylor coefficients.
        const double square = length * length;
        const double a1 = length * slope(from), a2 = square * (c2_ + 6 * c4_ * (from * from)),
                     a3 = square * length * (4 * c4_ * from);
        const bool signs[5] = {in, at_from + 0.25 * a1 > 0, at_from + 0.5 * a1 + a2 * (1 / 6.0) > 0,
                               at_from + 0.75 * a1 + 0.5 * a2 + 0.25 * a3 > 0, at_to > 0};
        int changes = 0;
        for (int k = 0; k < 4; ++k) changes += signs[k] != signs[k + 1];
        if (changes > 1 && length > least_length_) {
            width = 0.5 * length;
            continue;
        }
        if (signs[0] != signs[4] && found.count < 4)
            found.at[found.count++] = {root(from, to, at_from, at_to), signs[4] != complement_, -1};
        from = to;
        at_from = at_to;
        in = signs[4];
        width = 2 * length;
    }
    return found;
}

double TorusOnRay::root(double from, double to, double at_from, double at_to) const {
    const bool in = at_from > 0;
    double a = from, b = to, u = from + (to - from) * (at_from / (at_from - at_to));
    for (int k = 0; k < max_steps; ++k) {
        const double f = value(u);
        ((f > 0) == in ? a : b) = u;
        double next = u - f / slope(u);
        if (!(next > a && next < b)) next = 0.5 * (a + b);
        const double moved = std::abs(next - u);
        u = next;
        if (moved <= tolerance_) break;
    }
    const double nearer = nearer_by_distance(u);
    if (nearer >= from && nearer <= to) u = nearer;
    return std::min(std::max(u + middle_, t0_), t1_);
}

double TorusOnRay::nearer_by_distance(double u) const {
    const double s = std::sqrt(start_square_ + u * (2 * start_rate_ + u * rate_square_)), out = s - ring_;
    const double h = height_ + climb_ * u, distance = std::sqrt(out * out + h * h);
    const double rate = (out * ((start_rate_ + u * rate_square_) / s) + h * climb_) / distance;
    return u - (distance - tube_) / rate;
}

}  // namespace deburr
