#include "bounds/tangent_seams.hpp"

#include <algorithm>

#include "bounds/bounding_box.hpp"
#include "bounds/box_range.hpp"

namespace deburr {
namespace {

using Kind = RoundCoordinate::Kind;

// Lengths count as equal within this part of the radius: a seam that is off by more is an edge, however small.
constexpr double same = 1e-6;
// A bulge of less is not told, in radii.
constexpr double least_bulge = 0.02;
// Points along a line or a circle of contact that are looked at.
constexpr int along = 64;
// Places of a torus's circle between which the other's coordinate is stationary once at the most, but for tori that
// nearly touch twice: a multiple of `along`.
constexpr int around_tube = 256;

enum class Shape { plane, sphere, cylinder, cone, torus };

Shape shape_of(const HalfSpace& h) {
    if (!h.round) return Shape::plane;
    if (h.round->kind == Kind::point) return Shape::sphere;
    if (h.round->kind == Kind::circle) return Shape::torus;
    return h.round->is_cone() ? Shape::cone : Shape::cylinder;
}

Vec3 any_across(Vec3 axis) {
    return glm::normalize(glm::cross(axis, std::abs(axis.x) < 0.5 ? Vec3(1, 0, 0) : Vec3(0, 1, 0)));
}

// Where the surfaces of two parts have a point and their normal in common.
class Contact {
public:
    Contact(const Box& box) : middle_(0.5 * (box.lo + box.hi)), reach_(0.5 * glm::distance(box.lo, box.hi)) {}

    const std::vector<Vec3>& of(const HalfSpace& first, const HalfSpace& second) {
        points_.clear();
        const HalfSpace *a = &first, *b = &second;
        if (shape_of(*a) > shape_of(*b)) std::swap(a, b);
        near_ = same * std::min(a->radius, b->radius);
        if (shape_of(*b) == Shape::torus) {
            tube(*b, *a);
            return points_;
        }
        switch (shape_of(*a)) {
            case Shape::plane: plane(*a, *b); break;
            case Shape::sphere: sphere(*a, *b); break;
            case Shape::cylinder: cylinder(*a, *b); break;
            default: break;
        }
        return points_;
    }

private:
    bool equal(double x, double y) const { return std::abs(x - y) <= near_; }

    // Through x, along the unit direction, as far as the box is.
    void line(Vec3 x, Vec3 direction) {
        const Vec3 nearest = x + direction * glm::dot(direction, middle_ - x);
        for (int k = 0; k <= along; ++k) points_.push_back(nearest + direction * (reach_ * (2.0 * k / along - 1)));
    }
    void circle(Vec3 center, Vec3 axis, double radius) {
        const Vec3 u = any_across(axis), v = glm::cross(axis, u);
        for (int k = 0; k < along; ++k) {
            const double angle = 2 * 3.14159265358979323846 * (k + 0.5) / along;
            points_.push_back(center + radius * (std::cos(angle) * u + std::sin(angle) * v));
        }
    }

    void plane(const HalfSpace& p, const HalfSpace& other) {
        const RoundCoordinate& c = *other.round;
        const double d = p.distance(c.center), R = other.offset, tilt = glm::dot(p.normal, c.axis);
        switch (shape_of(other)) {
            case Shape::sphere:
                if (equal(std::abs(d), R)) points_.push_back(c.center - d * p.normal);
                break;
            case Shape::cylinder:
                if (std::abs(tilt) < same && equal(std::abs(d), R)) line(c.center - d * p.normal, c.axis);
                break;
            case Shape::cone: {
                const Vec3 apex = c.center + c.axis * (R / c.along);
                if (!equal(p.distance(apex), 0) || std::abs(std::abs(tilt) - std::abs(c.along)) > same) break;
                line(apex, glm::normalize(c.axis - p.normal * tilt));
                break;
            }
            default: break;
        }
    }

    void sphere(const HalfSpace& ball, const HalfSpace& other) {
        const RoundCoordinate &c = *other.round, &b = *ball.round;
        const Vec3 away = b.center - c.center;
        switch (shape_of(other)) {
            case Shape::sphere: {
                const double distance = glm::length(away);
                if (distance > near_ && equal(distance, std::abs(ball.offset - other.offset)))
                    points_.push_back(b.center +
                                      away * ((ball.offset < other.offset ? 1 : -1) * ball.offset / distance));
                break;
            }
            case Shape::cylinder: {
                const Vec3 out = away - c.axis * glm::dot(c.axis, away);
                const double distance = glm::length(out);
                if (distance <= near_ && equal(ball.offset, other.offset))
                    circle(b.center, c.axis, ball.offset);
                else if (distance > near_ && equal(distance, std::abs(ball.offset - other.offset)))
                    points_.push_back(b.center +
                                      out * ((ball.offset < other.offset ? 1 : -1) * ball.offset / distance));
                break;
            }
            case Shape::cone: {
                // A ball within: it touches along a circle where its center has the distance R from the cone's side.
                const double t = glm::dot(c.axis, away);
                if (glm::length(away - c.axis * t) > near_ || !equal(other.offset - c.along * t, ball.offset)) break;
                circle(b.center + c.axis * (c.along * ball.offset), c.axis, c.across * ball.offset);
                break;
            }
            default: break;
        }
    }

    void cylinder(const HalfSpace& rod, const HalfSpace& other) {
        const RoundCoordinate &r = *rod.round, &c = *other.round;
        const double tilt = std::abs(glm::dot(r.axis, c.axis));
        const Vec3 away = r.center - c.center, out = away - c.axis * glm::dot(c.axis, away);
        const double distance = glm::length(out);
        if (shape_of(other) != Shape::cylinder) return;
        if (tilt >= 1 - same) {
            if (distance > near_ && equal(distance, std::abs(rod.offset - other.offset)))
                line(r.center + out * ((rod.offset < other.offset ? 1 : -1) * rod.offset / distance), r.axis);
            return;
        }
        // Both have the normal n, along which the axes are apart, where they touch.
        const Vec3 n = glm::normalize(glm::cross(r.axis, c.axis)), nearest = nearest_to(r, c);
        for (const double side : {1.0, -1.0})
            if (equal(glm::dot(n, c.center - r.center), side * (rod.offset - other.offset)))
                points_.push_back(nearest + side * rod.offset * n);
    }

    // The point of the first axis that is nearest to the second.
    static Vec3 nearest_to(const RoundCoordinate& first, const RoundCoordinate& second) {
        const Vec3 across = first.axis - second.axis * glm::dot(first.axis, second.axis);
        return first.center +
               first.axis * (glm::dot(second.center - first.center, across) / glm::dot(first.axis, across));
    }

    // A surface touches a tube of radius a with the same normal where, on the tube's circle, its coordinate is
    // stationary and a less than on the surface; where it is inside the tube, the coordinate counts from its other
    // side.
    void tube(const HalfSpace& torus, const HalfSpace& other) {
        const RoundCoordinate& c = *torus.round;
        const Vec3 u = any_across(c.axis), v = glm::cross(c.axis, u);
        const auto tangent = [&](double angle) { return std::cos(angle) * v - std::sin(angle) * u; };
        const auto on_circle = [&](double angle) {
            return c.center + c.ring * (std::cos(angle) * u + std::sin(angle) * v);
        };
        const auto coordinate = [&](Vec3 x) { return other.round ? other.round->at(x) : glm::dot(other.normal, x); };
        const auto slope = [&](double angle) {
            const Vec3 x = on_circle(angle);
            return glm::dot(other.round ? other.round->gradient(x) : other.normal, tangent(angle));
        };
        const auto add = [&](double angle) { touch(torus, other, on_circle(angle), tangent(angle)); };
        const auto angle_of = [](int k) { return 2 * 3.14159265358979323846 * (k + 0.5) / around_tube; };
        Range values{infinity, -infinity};
        for (int k = 0; k < around_tube; ++k) {
            const double value = coordinate(on_circle(angle_of(k)));
            values = {std::min(values.lo, value), std::max(values.hi, value)};
        }
        if (values.hi - values.lo <= near_) {
            for (int k = 0; k < along; ++k) add(angle_of(k * (around_tube / along)));
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
                add(0.5 * (low + high));
            }
            at_start = at_end;
        }
    }

    // Where they touch beside x, a point of the torus's circle with this tangent, at which the other's coordinate is
    // stationary.
    void touch(const HalfSpace& torus, const HalfSpace& other, Vec3 x, Vec3 tangent) {
        const double a = torus.offset, apart = other.offset - a;
        const Shape shape = shape_of(other);
        if (shape == Shape::plane || shape == Shape::cone) {
            const double value = other.round ? other.round->at(x) : glm::dot(other.normal, x);
            const Vec3 normal = other.round ? other.round->gradient(x) : other.normal;
            if (equal(value, apart)) points_.push_back(x + a * normal);
            return;
        }
        const RoundCoordinate& c = *other.round;
        if (!equal(c.at(x), std::abs(apart))) return;
        if (std::abs(apart) > near_) {
            points_.push_back(x + (apart > 0 ? a : -a) * c.gradient(x));
            return;
        }
        // Tubes of one radius whose circles or axes meet: across both, or all around where they run on.
        Vec3 across(0.0);
        if (shape == Shape::cylinder) across = glm::cross(tangent, c.axis);
        if (shape == Shape::torus) {
            const Vec3 y = x - c.center;
            across = glm::cross(tangent, glm::normalize(glm::cross(c.axis, y)));
        }
        const double length = glm::length(across);
        if (length < same) {
            circle(x, tangent, a);
            return;
        }
        points_.push_back(x + across * (a / length));
        points_.push_back(x - across * (a / length));
    }

    Vec3 middle_;
    double reach_, near_ = 0;
    std::vector<Vec3> points_;
};

bool is_in(const std::vector<HalfSpace>& all, const HalfSpace& h) {
    return std::any_of(all.begin(), all.end(), [&](const HalfSpace& k) {
        return k.round == h.round && k.offset == h.offset && (h.round || k.normal == h.normal);
    });
}

// How far from x, along the normal, the density is ½; 0 if there is no such place within a radius.
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
            for (const Vec3& x : contact.of(a, b)) {
                if (!inflated(box, radius).contains(x)) continue;
                const Vec3 normal = b.normal_at(x);
                if (!(glm::dot(normal, a.normal_at(x)) > 0)) continue;  // they touch from either side
                // Both have to bound the solid here.
                const DensityTree here = prune(tree, inflated({x, x}, 1e-3 * radius)).tree;
                if (!is_in(here.half_spaces, a) || !is_in(here.half_spaces, b)) continue;
                const double bulge = distance_from(tree, x, normal, radius);
                if (bulge > worst.bulge) worst = {x, bulge, radius};
            }
            if (worst.bulge > least_bulge * radius) found.push_back(worst);
        }
    }
    return found;
}

}  // namespace deburr
