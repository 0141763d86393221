#include "bounds/tangent_seams.hpp"

#include <algorithm>
#include <utility>

#include "bounds/bounding_box.hpp"
#include "bounds/box_range.hpp"

namespace deburr {
namespace {

// Lengths count as equal within this fraction of the filter radius; a seam that is off by more is an edge.
constexpr double same = 1e-6;
// Smaller bulges are not reported; in filter radii.
constexpr double least_bulge = 0.02;
// The number of points that are tried along a line or circle of contact.
constexpr int looked_at = 64;
// The number of arcs of a torus's circle; the other surface's coordinate is taken to be stationary at most once in
// each, which fails only for tori that nearly touch twice. It is a multiple of `looked_at`.
constexpr int around_tube = 256;

enum class Shape { plane, sphere, cylinder, cone, torus };

Shape shape_of(const HalfSpace& h) {
    if (!h.round) return Shape::plane;
    if (h.round->kind == RoundCoordinate::Kind::point) return Shape::sphere;
    if (h.round->kind == RoundCoordinate::Kind::circle) return Shape::torus;
    return h.round->is_cone() ? Shape::cone : Shape::cylinder;
}

/// A unit vector perpendicular to `axis`.
Vec3 any_across(Vec3 axis) {
    return glm::normalize(glm::cross(axis, std::abs(axis.x) < 0.5 ? Vec3(1, 0, 0) : Vec3(0, 1, 0)));
}

Vec3 apex_of(const HalfSpace& cone) {
    return cone.round->center + cone.round->axis * (cone.offset / cone.round->along);
}

// A line on a cylinder, or a half-line from a cone's apex; the surface has one normal along it.
struct Ruling {
    Vec3 from, along;
    bool is_half;
    bool reaches(Vec3 x, double near) const { return !is_half || glm::dot(x - from, along) >= -near; }
};

// The ruling of a cylinder or cone along which its normal is `normal`, which must make the right angle with the axis.
Ruling ruling(const HalfSpace& h, Vec3 normal) {
    const RoundCoordinate& c = *h.round;
    if (!c.is_cone()) return {c.center + h.offset * normal, c.axis, false};
    const Vec3 along = glm::normalize(c.axis - normal * c.along);
    return {apex_of(h), c.along > 0 ? -along : along, true};
}

// The unit vectors n with n·a = p and n·b = q, where a and b are unit vectors that are not parallel. There are none or
// two; where the two nearly coincide, as rounding may have moved them, the one in the plane of a and b is also
// returned.
struct UnitVectors {
    int count = 0;
    Vec3 all[3];
    const Vec3* begin() const { return all; }
    const Vec3* end() const { return all + count; }
};
UnitVectors common_normals(Vec3 a, double p, Vec3 b, double q) {
    const double tilt = glm::dot(a, b), square = 1 - tilt * tilt;
    const Vec3 flat = (a * (p - q * tilt) + b * (q - p * tilt)) / square, out = glm::cross(a, b);
    const double rest = 1 - glm::dot(flat, flat);
    UnitVectors found;
    if (std::abs(rest) < same) found.all[found.count++] = glm::normalize(flat);
    if (rest > 0)
        for (const double sign : {1.0, -1.0}) found.all[found.count++] = flat + out * (sign * std::sqrt(rest / square));
    return found;
}

// Points where the surfaces of two parts touch: their normals are equal there, or opposite, as those of a wall and of
// the rod outside of which a fillet remains.
class Contact {
public:
    Contact(const Box& box) : middle_(0.5 * (box.lo + box.hi)), reach_(0.5 * glm::distance(box.lo, box.hi)) {}

    /// Points along which the surfaces touch within the box; valid until the next call.
    const std::vector<Vec3>& of(const HalfSpace& first, const HalfSpace& second) {
        points_.clear();
        const HalfSpace *a = &first, *b = &second;
        if (shape_of(*a) > shape_of(*b)) std::swap(a, b);
        near_ = same * std::min(a->radius, b->radius);
        if (shape_of(*b) == Shape::torus) {
            tube(*b, *a);
            return points_;
        }
        for (const double side : {1.0, -1.0}) switch (shape_of(*a)) {
                case Shape::plane: plane(*a, *b, side); break;
                case Shape::sphere: sphere(*a, *b, side); break;
                default: ruled(*a, *b, side);
            }
        return points_;
    }

private:
    bool equal(double x, double y) const { return std::abs(x - y) <= near_; }
    bool is_parallel(Vec3 a, Vec3 b) const { return std::abs(glm::dot(a, b)) >= 1 - same; }

    void add(Vec3 x) { points_.push_back(x); }
    // Adds points of the line within the box's circumscribed ball for which reaches(x).
    template <class Reaches>
    void line(Vec3 x, Vec3 direction, Reaches reaches) {
        const Vec3 nearest = x + direction * glm::dot(direction, middle_ - x);
        for (int k = 0; k <= looked_at; ++k) {
            const Vec3 y = nearest + direction * (reach_ * (2.0 * k / looked_at - 1));
            if (reaches(y)) add(y);
        }
    }
    /// Adds points of the circle.
    void circle(Vec3 center, Vec3 axis, double radius) {
        const Vec3 u = any_across(axis), v = glm::cross(axis, u);
        for (int k = 0; k < looked_at; ++k) {
            const double angle = 2 * pi * (k + 0.5) / looked_at;
            add(center + radius * (std::cos(angle) * u + std::sin(angle) * v));
        }
    }

    // In the following functions the second part's normal is `side` times that of the first.

    void plane(const HalfSpace& p, const HalfSpace& other, double side) {
        const RoundCoordinate& c = *other.round;
        const Vec3 normal = side * p.normal;
        if (shape_of(other) == Shape::sphere) {
            const Vec3 x = c.center + other.offset * normal;
            if (equal(p.distance(x), 0)) add(x);
            return;
        }
        if (std::abs(glm::dot(normal, c.axis) - c.along) > same) return;
        const Ruling at = ruling(other, normal);
        if (equal(p.distance(at.from), 0)) line(at.from, at.along, [&](Vec3 x) { return at.reaches(x, near_); });
    }

    void sphere(const HalfSpace& ball, const HalfSpace& other, double side) {
        const RoundCoordinate &c = *other.round, &b = *ball.round;
        const Vec3 away = b.center - c.center;
        const double t = glm::dot(c.axis, away);
        const Vec3 out = shape_of(other) == Shape::sphere ? away : away - c.axis * t;
        const double distance = glm::length(out), moved = side * ball.offset;
        if (shape_of(other) == Shape::cone) {
            if (distance <= near_) {
                if (side > 0 && equal(c.along * t + moved, other.offset))
                    circle(b.center + c.axis * (c.along * moved), c.axis, c.across * moved);
                return;
            }
            for (const double beyond : {1.0, -1.0}) {  // the axis
                const double across = beyond * c.across;
                const Vec3 normal = across / distance * out + c.along * c.axis;
                if (equal(across * distance + c.along * t + moved, other.offset) &&
                    beyond * distance + moved * c.across >= 0)
                    add(b.center + moved * normal);
            }
            return;
        }
        const double apart = other.offset - moved;
        if (distance > near_ && equal(distance, std::abs(apart)))
            add(b.center + out * (moved / apart));
        else if (shape_of(other) == Shape::cylinder && distance <= near_ && equal(apart, 0))
            circle(b.center, c.axis, ball.offset);
    }

    // Two cylinders or cones. They touch where they have rulings in one tangent plane: where these cross, or all along.
    void ruled(const HalfSpace& a, const HalfSpace& b, double side) {
        const RoundCoordinate &p = *a.round, &q = *b.round;
        if (!is_parallel(p.axis, q.axis)) {
            for (const Vec3& n : common_normals(p.axis, p.along, q.axis, side * q.along))
                rulings(ruling(a, n), ruling(b, side * n), n);
            return;
        }
        const double turned = glm::dot(p.axis, q.axis) < 0 ? -1 : 1;
        if (std::abs(p.along - turned * side * q.along) > same) return;
        if (!p.is_cone()) {
            const Vec3 away = p.center - q.center, out = away - q.axis * glm::dot(q.axis, away);
            const double distance = glm::length(out), apart = side * b.offset - a.offset;
            if (distance > near_ && equal(distance, std::abs(apart)))
                rulings(ruling(a, out / apart), ruling(b, side * out / apart), out / apart);
            return;
        }
        // Cones of equal angle touch if the apex of one is on the other.
        Vec3 n(0.0);
        if (equal(p.at(apex_of(b)), a.offset))
            n = p.gradient(apex_of(b));
        else if (equal(q.at(apex_of(a)), b.offset))
            n = side * q.gradient(apex_of(a));
        if (glm::distance(apex_of(a), apex_of(b)) > near_ && n != Vec3(0.0))
            rulings(ruling(a, n), ruling(b, side * n), n);
    }

    /// Contact of two rulings in planes with this normal.
    void rulings(const Ruling& p, const Ruling& q, Vec3 normal) {
        const Vec3 between = q.from - p.from;
        if (!equal(glm::dot(normal, between), 0)) return;
        const auto reach = [&](Vec3 x) { return p.reaches(x, near_) && q.reaches(x, near_); };
        const double turn = glm::dot(normal, glm::cross(p.along, q.along));
        if (std::abs(turn) < same) {
            if (equal(glm::length(between - p.along * glm::dot(between, p.along)), 0)) line(p.from, p.along, reach);
            return;
        }
        const Vec3 x = p.from + p.along * (glm::dot(normal, glm::cross(between, q.along)) / turn);
        if (reach(x)) add(x);
    }

    // A surface touches a tube of radius a where, on the tube's circle, its coordinate is stationary and differs by a
    // from its value on the surface; where the circle's point is beyond the surface's axis, the mirrored coordinate
    // counts.
    void tube(const HalfSpace& torus, const HalfSpace& other) {
        if (!other.round) {
            stationary(
                torus, [&](Vec3 x) { return glm::dot(other.normal, x); }, [&](Vec3) { return other.normal; }, other);
            return;
        }
        const auto search = [&](const RoundCoordinate& c) {
            stationary(
                torus, [&](Vec3 x) { return c.at(x); }, [&](Vec3 x) { return c.gradient(x); }, other);
        };
        search(*other.round);
        // Points of the circle beyond the other's axis have the mirrored coordinate.
        RoundCoordinate beyond = other.round->mirrored();
        beyond.ring = -beyond.ring;
        if (shape_of(other) == Shape::cone || shape_of(other) == Shape::torus) search(beyond);
    }

    /// Calls touch() where the other's coordinate is stationary along the torus's circle.
    template <class Coordinate, class Gradient>
    void stationary(const HalfSpace& torus, Coordinate coordinate, Gradient gradient, const HalfSpace& other) {
        const RoundCoordinate& c = *torus.round;
        const Vec3 u = any_across(c.axis), v = glm::cross(c.axis, u);
        const auto tangent = [&](double angle) { return std::cos(angle) * v - std::sin(angle) * u; };
        const auto on_circle = [&](double angle) {
            return c.center + c.ring * (std::cos(angle) * u + std::sin(angle) * v);
        };
        const auto slope = [&](double angle) { return glm::dot(gradient(on_circle(angle)), tangent(angle)); };
        const auto touches = [&](double angle) {
            const Vec3 x = on_circle(angle);
            touch(torus, other, x, tangent(angle), coordinate(x), gradient(x));
        };
        const auto angle_of = [](int k) { return 2 * 3.14159265358979323846 * (k + 0.5) / around_tube; };
        Range values{infinity, -infinity};
        for (int k = 0; k < around_tube; ++k) {
            const double value = coordinate(on_circle(angle_of(k)));
            values = {std::min(values.lo, value), std::max(values.hi, value)};
        }
        if (values.hi - values.lo <= near_) {
            for (int k = 0; k < looked_at; ++k) touches(angle_of(k * (around_tube / looked_at)));
            return;
        }
        double at_start = slope(angle_of(0));
        for (int k = 0; k < around_tube; ++k) {
            double low = angle_of(k), high = angle_of(k + 1);
            const double at_end = slope(high);
            if ((at_start < 0) != (at_end < 0)) {
                constexpr int halvings = 48;
                for (int i = 0; i < halvings; ++i) {
                    const double middle = 0.5 * (low + high);
                    ((slope(middle) < 0) == (at_start < 0) ? low : high) = middle;
                }
                touches(0.5 * (low + high));
            }
            at_start = at_end;
        }
    }

    // Adds the points beside x where the two touch. x is a point of the torus's circle with this tangent, at which the
    // other's coordinate is stationary and has this value and gradient.
    void touch(const HalfSpace& torus, const HalfSpace& other, Vec3 x, Vec3 tangent, double value, Vec3 gradient) {
        const Shape shape = shape_of(other);
        const auto try_normal = [&](Vec3 normal, double moved) {  // of the other
            const Vec3 y = x + moved * normal;
            if (!other.round || std::abs(other.round->at(y) - other.offset) <= 4 * near_) add(y);
        };
        for (const double side : {1.0, -1.0}) {
            const double moved = side * torus.offset, apart = other.offset - moved;
            if (shape == Shape::plane) {
                if (equal(value, apart)) try_normal(gradient, moved);
                continue;
            }
            const RoundCoordinate& c = *other.round;
            const bool is_cone = shape == Shape::cone;
            if (!equal(value, is_cone ? apart : std::abs(apart))) continue;
            const Vec3 y = x - c.center;
            const bool has_normal = is_cone ? glm::length(glm::cross(c.axis, y)) > near_ : std::abs(apart) > near_;
            if (has_normal) {
                try_normal(is_cone || apart > 0 ? gradient : -gradient, moved);
                continue;
            }
            // x is on the other's axis or circle: the normal is perpendicular to both tangents, or any if both run on
            // together.
            const Vec3 direction = shape == Shape::torus    ? glm::normalize(glm::cross(c.axis, y))
                                   : shape == Shape::sphere ? tangent
                                                            : c.axis;
            if (is_parallel(tangent, direction)) {
                if (!is_cone) circle(x, tangent, torus.offset);
                continue;
            }
            for (const Vec3& n : common_normals(tangent, 0, direction, is_cone ? c.along : 0)) try_normal(n, moved);
        }
    }

    Vec3 middle_;
    double reach_, near_ = 0;
    std::vector<Vec3> points_;
};

/// Whether one of the half-spaces is h.
bool is_in(const std::vector<HalfSpace>& all, const HalfSpace& h) {
    return std::any_of(all.begin(), all.end(), [&](const HalfSpace& k) {
        return k.round == h.round && k.offset == h.offset && (h.round || k.normal == h.normal);
    });
}

// Distance from x, along the normal in either direction, at which the density is ½; 0 if that is farther than a radius.
double distance_from(const DensityTree& tree, Vec3 x, Vec3 normal, double radius) {
    const double here = tree.at(x) - 0.5, side = here > 0 ? 1 : -1;
    double near = 0, far = radius;
    if ((tree.at(x + side * far * normal) > 0.5) == (here > 0)) {
        if ((tree.at(x - side * far * normal) > 0.5) == (here > 0)) return 0;
        normal = -normal;
    }
    constexpr int halvings = 20;
    for (int i = 0; i < halvings; ++i) {
        const double middle = 0.5 * (near + far);
        ((tree.at(x + side * middle * normal) > 0.5) == (here > 0) ? near : far) = middle;
    }
    return far;
}

}  // namespace

std::vector<TangentSeam> tangent_seams(const DensityTree& tree, int max_pairs) {
    std::vector<TangentSeam> found;
    if (!tree.rounds) return found;
    const Box box = bounding_box(tree);
    if (box.empty() || !box.finite()) return found;
    Contact contact(box);
    const std::vector<HalfSpace>& all = tree.half_spaces;
    const auto may_touch = [](const HalfSpace& h) {
        return h.radius > 0 && !(h.round && !h.round->is_cone() && h.offset <= 0) &&
               !(h.round && h.round->is_concave());
    };
    for (std::size_t i = 0; i < all.size() && max_pairs > 0; ++i) {
        if (!may_touch(all[i])) continue;
        for (std::size_t k = 0; k < all.size() && max_pairs > 0; ++k) {
            const HalfSpace &a = all[i], &b = all[k];
            if (!b.round || !may_touch(b) || (a.round && (k <= i || a.round->is_same(*b.round)))) continue;
            --max_pairs;
            const double radius = std::min(a.radius, b.radius);
            TangentSeam worst;
            std::size_t others = all.size();  // how many half-spaces vary there
            for (const Vec3& x : contact.of(a, b)) {
                if (!inflated(box, radius).contains(x)) continue;
                const Vec3 normal = b.normal_at(x);
                // Both half-spaces must bound the solid here.
                const DensityTree here = prune(tree, inflated({x, x}, 1e-3 * radius)).tree;
                if (!is_in(here.half_spaces, a) || !is_in(here.half_spaces, b)) continue;
                const double bulge = distance_from(tree, x, normal, radius);
                if (bulge <= least_bulge * radius) continue;
                // At a seam's ends the distance is due to rounded edges, too, so points where fewer half-spaces vary
                // are preferred.
                const std::size_t vary = prune(tree, inflated({x, x}, radius)).tree.half_spaces.size();
                if (std::pair(vary, -bulge) >= std::pair(others, -worst.bulge)) continue;
                worst = {x, bulge, radius};
                others = vary;
            }
            if (worst.bulge > 0) found.push_back(worst);
        }
    }
    return found;
}

}  // namespace deburr
