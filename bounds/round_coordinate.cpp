#include "bounds/round_coordinate.hpp"

#include <array>

namespace deburr {
namespace {

// Parts that are the same through different chains of transforms differ by a few ε; a millionth of a degree is 2·10⁻⁸.
constexpr double equal_direction = 1e-9, equal_length = 1e-11;

// √(a² + b²). The library's hypot takes five times as long, because it also handles numbers whose squares overflow.
double length_of(double a, double b) { return std::sqrt(a * a + b * b); }

/// The vector with one coordinate `value` and two that are 0.
Vec3 component(double Vec3::*of, double value) {
    Vec3 v(0.0);
    v.*of = value;
    return v;
}

// The number of the coordinate axis that the unit vector lies along; −1 if it is none.
int coordinate_axis(Vec3 axis) {
    for (int k = 0; k < 3; ++k)
        if (std::abs(axis[k]) == 1) return k;
    return -1;
}

// Range of the absolute values of the numbers in the interval.
Range absolute(Range r) {
    if (r.lo > 0) return r;
    if (r.hi < 0) return {-r.hi, -r.lo};
    return {0, std::max(-r.lo, r.hi)};
}

/// Range of axis·(x − center) over the box.
Range along(Vec3 axis, Vec3 center, const Box& box) {
    Range t;
    for (int k = 0; k < 3; ++k) {
        if (axis[k] == 0) continue;  // 0·∞ would be NaN
        const double a = axis[k] * (box.lo[k] - center[k]), b = axis[k] * (box.hi[k] - center[k]);
        t.lo += std::min(a, b);
        t.hi += std::max(a, b);
    }
    return t;
}

// Distance from the origin to the segment from m − g to m + g.
double distance_to_side(Vec3 m, Vec3 g) { return distance_to_segment(Vec3(0.0), m - g, m + g); }

// Least distance of a finite box from the axis. The box's projection along the axis is a polygon with two opposite
// sides for each direction of the box's edges.
double least_distance_from_axis(Vec3 axis, Vec3 center, const Box& box) {
    const auto shadow = [&](Vec3 v) { return v - axis * glm::dot(axis, v); };
    const Vec3 middle = shadow(0.5 * (box.lo + box.hi) - center), half = 0.5 * (box.hi - box.lo);
    const std::array<Vec3, 3> edges = {shadow(component(&Vec3::x, half.x)), shadow(component(&Vec3::y, half.y)),
                                       shadow(component(&Vec3::z, half.z))};
    bool within = true;
    double least = infinity;
    for (int i = 0; i < 3; ++i) {
        const Vec3 normal = glm::cross(axis, edges[i]);
        Vec3 side(0.0);  // from the projection's middle to the side's middle
        double reach = 0;
        for (int j = 0; j < 3; ++j) {
            if (j == i) continue;
            const double out = glm::dot(normal, edges[j]);
            side += out < 0 ? -edges[j] : edges[j];
            reach += std::abs(out);
        }
        within &= std::abs(glm::dot(normal, middle)) <= reach;
        least = std::min({least, distance_to_side(middle + side, edges[i]), distance_to_side(middle - side, edges[i])});
    }
    return within ? 0 : least;
}

Vec3 corner(const Box& box, int i) {
    return {(i & 1) != 0 ? box.hi.x : box.lo.x, (i & 2) != 0 ? box.hi.y : box.lo.y, (i & 4) != 0 ? box.hi.z : box.lo.z};
}

// Range of the distances from the axis over the box; just [0, ∞) for an unbounded box at a slant.
Range distance_range(Vec3 axis, Vec3 center, const Box& box) {
    double near = 0, far = 0;
    if (const int k = coordinate_axis(axis); k >= 0) {
        for (int j = 0; j < 3; ++j) {
            if (j == k) continue;
            const Range d = absolute({box.lo[j] - center[j], box.hi[j] - center[j]});
            near += d.lo * d.lo;
            far += d.hi * d.hi;
        }
        return {std::sqrt(near), std::sqrt(far)};
    }
    if (!box.finite()) return {0, infinity};
    for (int i = 0; i < 8; ++i) {
        const Vec3 away = corner(box, i) - center, across = away - axis * glm::dot(axis, away);
        far = std::max(far, glm::dot(across, across));
    }
    return {least_distance_from_axis(axis, center, box), std::sqrt(far)};
}

}  // namespace

RoundCoordinate RoundCoordinate::distance_from_point(Vec3 center) {
    RoundCoordinate c;
    c.center = center;
    return c;
}

RoundCoordinate RoundCoordinate::distance_from_axis(Vec3 center, Vec3 axis) { return across_cone(center, axis, 1, 0); }

RoundCoordinate RoundCoordinate::across_cone(Vec3 center, Vec3 axis, double across, double along) {
    RoundCoordinate c;
    c.kind = Kind::axis;
    c.center = center;
    c.axis = axis;
    c.across = across;
    c.along = along;
    return c;
}

RoundCoordinate RoundCoordinate::distance_from_circle(Vec3 center, Vec3 axis, double ring) {
    RoundCoordinate c;
    c.kind = Kind::circle;
    c.center = center;
    c.axis = axis;
    c.ring = ring;
    return c;
}

double RoundCoordinate::at(Vec3 x) const {
    const Vec3 away = x - center;
    if (kind == Kind::point) return glm::length(away);
    const double t = glm::dot(axis, away), s = glm::length(away - axis * t);
    return kind == Kind::axis ? across * s + along * t : length_of(s - ring, t);
}

Vec3 RoundCoordinate::gradient(Vec3 x) const {
    const auto unit = [](Vec3 v) {
        const double length = glm::length(v);
        return length > 0 ? v / length : Vec3(0.0);
    };
    const Vec3 away = x - center;
    if (kind == Kind::point) return unit(away);
    const double t = glm::dot(axis, away);
    const Vec3 outward = away - axis * t, direction = unit(outward);
    if (kind == Kind::axis) return across * direction + along * axis;
    return unit((glm::length(outward) - ring) * direction + t * axis);
}

Range RoundCoordinate::range(const Box& box) const {
    if (kind == Kind::point) {
        double near = 0, far = 0;
        for (int k = 0; k < 3; ++k) {
            const Range d = absolute({box.lo[k] - center[k], box.hi[k] - center[k]});
            near += d.lo * d.lo;
            far += d.hi * d.hi;
        }
        return {std::sqrt(near), std::sqrt(far)};
    }
    const Range s = distance_range(axis, center, box);
    if (kind == Kind::axis && along == 0) return s;
    const Range t = deburr::along(axis, center, box);
    if (kind == Kind::circle) {
        const Range p = absolute({s.lo - ring, s.hi - ring}), q = absolute(t);
        return {length_of(p.lo, q.lo), length_of(p.hi, q.hi)};
    }
    const auto product = [](double k, Range r) {
        return k < 0 ? Range{k * r.hi, k * r.lo} : Range{k * r.lo, k * r.hi};
    };
    const Range a = product(across, s), b = product(along, t);
    Range u{a.lo + b.lo, a.hi + b.hi};
    if (coordinate_axis(axis) >= 0 || !box.finite()) return u;
    // u's gradient is a unit vector. So within a face of the box u is stationary only along lines on the cone, which
    // run on to the face's edges, and within the box only on the axis: the edges and the axis hold the least and
    // greatest values.
    u = {infinity, -infinity};
    const auto add = [&](Range r) { u = {std::min(u.lo, r.lo), std::max(u.hi, r.hi)}; };
    RoundOnRay on_edge;
    for (int from = 0; from < 8; ++from)
        for (const int bit : {1, 2, 4}) {
            if ((from & bit) != 0) continue;
            on_edge.set(*this, corner(box, from), corner(box, from | bit) - corner(box, from));
            add(on_edge.range(0, 1));
        }
    double enters = -infinity, leaves = infinity;
    for (int k = 0; k < 3; ++k) {
        const double from = (box.lo[k] - center[k]) / axis[k], to = (box.hi[k] - center[k]) / axis[k];
        if (axis[k] == 0 && !(box.lo[k] <= center[k] && center[k] <= box.hi[k])) return u;
        if (axis[k] == 0) continue;
        enters = std::max(enters, std::min(from, to));
        leaves = std::min(leaves, std::max(from, to));
    }
    if (enters <= leaves)
        add({std::min(this->along * enters, this->along * leaves),
             std::max(this->along * enters, this->along * leaves)});
    return u;
}

RoundCoordinate RoundCoordinate::mirrored() const {
    RoundCoordinate c = *this;
    c.across = -across;
    return c;
}

bool RoundCoordinate::is_same(const RoundCoordinate& other) const {
    const double size = 1 + std::max(largest(center), largest(other.center));
    return kind == other.kind && largest(center - other.center) <= equal_length * size &&
           (kind == Kind::point ||
            (largest(axis - other.axis) <= equal_direction && std::abs(across - other.across) <= equal_direction &&
             std::abs(along - other.along) <= equal_direction)) &&
           std::abs(ring - other.ring) <= equal_length * (1 + ring);
}

double even_scale(const Affine& map) {
    const Mat3 gram = glm::transpose(map.linear) * map.linear;
    const double square = gram[0][0];
    double worst = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) worst = std::max(worst, std::abs(gram[i][j] - (i == j ? square : 0)));
    constexpr double rounding = 256 * epsilon;
    return worst <= rounding * square ? std::sqrt(square) : 0;
}

RoundPart image(const Affine& map, const RoundPart& part) {
    using Kind = RoundCoordinate::Kind;
    const double scale = even_scale(map);
    RoundPart to = part;
    RoundCoordinate& c = to.coordinate;
    c.center = map(c.center);
    c.ring *= scale;
    to.offset *= scale;
    if (c.kind == Kind::point) return to;
    c.axis = glm::normalize(map.linear * c.axis);
    int first = 0;
    while (first < 2 && std::abs(c.axis[first]) < equal_direction) ++first;
    if (c.axis[first] < 0) {
        c.axis = -c.axis;
        c.along = -c.along;
    }
    if (c.kind == Kind::axis) {
        const double up = glm::dot(c.axis, c.center);
        c.center -= c.axis * up;
        to.offset += c.along * up;
    }
    return to;
}

// ---- along a ray -------------------------------------------------------------------------------------------------

void RoundOnRay::set(const RoundCoordinate& coordinate, Vec3 origin, Vec3 direction) {
    coordinate_ = &coordinate;
    Vec3 away = origin - coordinate.center, across = direction;
    whole_ = glm::dot(direction, direction);
    if (coordinate.kind != RoundCoordinate::Kind::point) {
        const Vec3 axis = coordinate.axis;
        height_ = glm::dot(axis, away);
        climb_ = glm::dot(axis, direction);
        away -= axis * height_;
        across -= axis * climb_;
    }
    square_ = glm::dot(across, across);
    // The ray is along the axis, up to rounding.
    if (square_ <= 16 * epsilon * epsilon * whole_) square_ = 0;
    nearest_ = square_ > 0 ? -glm::dot(away, across) / square_ : 0;
    const Vec3 foot = away + nearest_ * across;
    least_ = glm::dot(foot, foot);
}

double RoundOnRay::distance(double t) const {
    const double past = t - nearest_;
    return std::sqrt(least_ + square_ * past * past);
}

double RoundOnRay::at(double t) const {
    const double s = distance(t);
    const RoundCoordinate& c = *coordinate_;
    if (c.kind == RoundCoordinate::Kind::point) return s;
    return c.kind == RoundCoordinate::Kind::axis ? c.across * s + c.along * height(t)
                                                 : length_of(s - c.ring, height(t));
}

double RoundOnRay::slope(double t) const {
    const double s = distance(t), rate = s > 0 ? square_ * (t - nearest_) / s : 0;
    const RoundCoordinate& c = *coordinate_;
    if (c.kind == RoundCoordinate::Kind::point) return rate;
    if (c.kind == RoundCoordinate::Kind::axis) return c.across * rate + c.along * climb_;
    const double q = length_of(s - c.ring, height(t));
    return q > 0 ? ((s - c.ring) * rate + height(t) * climb_) / q : 0;
}

double RoundOnRay::least_on(double t0, double t1) const { return distance(std::clamp(nearest_, t0, t1)); }

double RoundOnRay::least_distance(double t0, double t1) const {
    return coordinate_->kind == RoundCoordinate::Kind::circle ? range(t0, t1).lo : least_on(t0, t1);
}

Range RoundOnRay::range(double t0, double t1) const {
    const RoundCoordinate& c = *coordinate_;
    const double a = at(t0), b = at(t1);
    if (c.kind == RoundCoordinate::Kind::point) return {least_on(t0, t1), std::max(a, b)};
    if (c.kind == RoundCoordinate::Kind::circle) {
        const Range s{least_on(t0, t1), std::max(distance(t0), distance(t1))};
        const double h0 = height(t0), h1 = height(t1);
        const Range p = absolute({s.lo - c.ring, s.hi - c.ring}), q = absolute({std::min(h0, h1), std::max(h0, h1)});
        return {length_of(p.lo, q.lo), length_of(p.hi, q.hi)};
    }
    Range u{std::min(a, b), std::max(a, b)};
    // Between the ends u is stationary where across·s′ = −along·t′. With k = s′ there, that is at a distance of k
    // √(least/(square (square − k²))) from the nearest point.
    const double k = c.across == 0 ? infinity : -c.along * climb_ / c.across;
    if (k * k < square_) {
        const double turn = nearest_ + k * std::sqrt(least_ / (square_ * (square_ - k * k)));
        if (turn > t0 && turn < t1) {
            const double value = at(turn);
            u = {std::min(u.lo, value), std::max(u.hi, value)};
        }
    }
    return u;
}

// s is convex, so |u′| is greatest at an end.
double RoundOnRay::max_slope(double t0, double t1) const {
    if (coordinate_->kind == RoundCoordinate::Kind::circle) return std::sqrt(whole_);
    return std::max(std::abs(slope(t0)), std::abs(slope(t1)));
}

double RoundOnRay::max_curvature(double t0, double t1) const {
    const RoundCoordinate& c = *coordinate_;
    // s″ = square·least/s³ ≤ square/s.
    const double s = least_on(t0, t1), bend = square_ == 0 ? 0
                                              : s > 0      ? square_ * std::min(1.0, least_ / (s * s)) / s
                                                           : infinity;
    if (c.kind != RoundCoordinate::Kind::circle) return std::abs(c.across) * bend;
    const double q = range(t0, t1).lo;
    return q > 0 ? whole_ / q + bend : infinity;
}

RoundOnRay::Crossings RoundOnRay::crossings(double offset) const {
    const RoundCoordinate& c = *coordinate_;
    // With p = t − nearest: across²·(least + square p²) = (room − rate p)², where room − rate p has the sign of
    // `across`.
    const double rate = c.kind == RoundCoordinate::Kind::point ? 0 : c.along * climb_;
    const double room = c.kind == RoundCoordinate::Kind::point ? offset : offset - c.along * height(nearest_);
    const double k = c.kind == RoundCoordinate::Kind::point ? 1 : c.across;
    const double A = k * k * square_ - rate * rate, B = room * rate,
                 C = k * k * least_ - room * room;  // A p² + 2 B p + C
    Crossings found;
    const auto add = [&](double p) {
        if (std::isfinite(p) && (room - rate * p) * k >= 0) found.t[found.count++] = nearest_ + p;
    };
    const double discriminant = B * B - A * C;
    if (!(discriminant >= 0)) return found;
    const double q = -(B + std::copysign(std::sqrt(discriminant), B));  // no cancellation
    const double first = q / A, second = q != 0 ? C / q : -first;
    if (A != 0) {
        add(std::min(first, second));
        add(std::max(first, second));
    } else if (q != 0) {
        add(second);
    }
    return found;
}

}  // namespace deburr
