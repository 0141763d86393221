// The formula is found by cutting the polygon's boundary at two corners of its convex hull, and each part again at
// further corners: at a corner of a part's hull, its two sides can be extended to infinity without meeting the part
// again. So either piece bounds a region of its own, and the part bounds their intersection if the corner is convex,
// and their union if it is not. A piece of one side bounds a half-plane.
#include "raytracer/scene/polygon.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <tuple>

namespace deburr {
namespace {

// Relative to the size of the polygon: a point closer than this to a line lies on it. Chosen as for hulls: points
// computed in a scene have errors of some 10⁻¹⁵, and nobody means features as small as 10⁻⁹ of the whole.
constexpr double polygon_flatness = 1e-9;

double cross(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }

bool before(Vec2 a, Vec2 b) { return std::tie(a.x, a.y) < std::tie(b.x, b.y); }

std::string text_of(Vec2 p) { return fmt::format("({}, {})", p.x, p.y); }

// The unit vector, without rounding if it is parallel to an axis.
Vec2 unit(Vec2 v) {
    v /= std::max(std::abs(v.x), std::abs(v.y));
    return v / glm::length(v) + Vec2(0.0);
}

class Polygon {
public:
    explicit Polygon(std::vector<Vec2> points) : points_(std::move(points)) {
        drop_repeated_points();
        find_size();
        drop_points_on_sides();
        if (area() < 0) std::reverse(points_.begin(), points_.end());
        // Any start will do; this is the least point, which is a corner of the hull.
        std::rotate(points_.begin(), std::min_element(points_.begin(), points_.end(), before), points_.end());
        check_simple();
    }

    std::size_t size() const { return points_.size(); }
    Vec2 point(std::size_t i) const { return points_[i % size()]; }
    Vec2 side(std::size_t i) const { return point(i + 1) - point(i); }
    /// Whether the boundary turns left at the corner where side i begins.
    bool turns_left(std::size_t i) const { return cross(side(i + size() - 1), side(i)) > 0; }
    bool convex() const {
        for (std::size_t i = 0; i < size(); ++i)
            if (!turns_left(i)) return false;
        return true;
    }

private:
    void drop_repeated_points() {
        for (Vec2& p : points_) p += Vec2(0.0);  // removes negative zeros
        points_.erase(std::unique(points_.begin(), points_.end()), points_.end());
        while (size() > 1 && points_.front() == points_.back()) points_.pop_back();
        if (size() < 3)
            throw std::runtime_error(fmt::format("expected a polygon of at least 3 different points, got {}", size()));
    }

    double area() const {
        double twice = 0;
        for (std::size_t i = 1; i + 1 < size(); ++i)
            twice += cross(points_[i] - points_[0], points_[i + 1] - points_[0]);
        return twice / 2;
    }

    void find_size() {
        Vec2 farthest = points_[0];
        for (const Vec2 p : points_)
            if (const double far = glm::distance(p, points_[0]); far > extent_) {
                extent_ = far;
                farthest = p;
            }
        const double most = polygon_flatness * extent_ * extent_;
        for (const Vec2 p : points_)
            if (std::abs(cross(farthest - points_[0], p - points_[0])) > most) return;
        throw std::runtime_error("expected a polygon with an area, got points on one line");
    }

    // Whether q lies between p and r on a straight line, and is not the tip of a spike.
    bool on_the_way(Vec2 p, Vec2 q, Vec2 r) const {
        const Vec2 in = q - p, out = r - q;
        return std::abs(cross(in, out)) <= polygon_flatness * extent_ * std::min(glm::length(in), glm::length(out)) &&
               glm::dot(in, out) > 0;
    }

    void drop_points_on_sides() {
        std::vector<Vec2> corners;
        for (std::size_t i = 0; i < size(); ++i)
            if (!on_the_way(point(i + size() - 1), point(i), point(i + 1))) corners.push_back(point(i));
        if (corners.size() < 3) throw std::runtime_error("expected a polygon with an area, got points on one line");
        points_ = std::move(corners);
    }

    // On which side of side i the point is: 1 left, −1 right, 0 on it, within the flatness.
    int turn(std::size_t i, Vec2 p) const {
        const double c = cross(side(i), p - point(i));
        return std::abs(c) <= polygon_flatness * extent_ * glm::length(side(i)) ? 0 : c > 0 ? 1 : -1;
    }

    bool on_side(std::size_t i, Vec2 p) const {
        const double along = glm::dot(p - point(i), side(i)), length = glm::dot(side(i), side(i));
        return turn(i, p) == 0 && along >= 0 && along <= length;
    }

    void check_simple() const {
        for (std::size_t i = 0; i < size(); ++i) {
            if (turn(i, point(i + 2)) == 0 && glm::dot(side(i), side(i + 1)) < 0)
                throw std::runtime_error(
                    fmt::format("expected a polygon that does not meet itself, got sides that turn back at {}",
                                text_of(point(i + 1))));
            for (std::size_t k = i + 2; k < size(); ++k) {
                if (i == 0 && k + 1 == size()) continue;  // neighbours share a corner
                check_apart(i, k);
            }
        }
    }

    void check_apart(std::size_t i, std::size_t k) const {
        const Vec2 a = point(i), b = point(i + 1), c = point(k), d = point(k + 1);
        if (std::max(a.x, b.x) < std::min(c.x, d.x) || std::max(c.x, d.x) < std::min(a.x, b.x) ||
            std::max(a.y, b.y) < std::min(c.y, d.y) || std::max(c.y, d.y) < std::min(a.y, b.y))
            return;
        for (const Vec2 p : {c, d})
            if (p == a || p == b)
                throw std::runtime_error(
                    fmt::format("expected a polygon that does not meet itself, got the point {} twice", text_of(p)));
        for (const auto& [on, p] : {std::pair(i, c), {i, d}, {k, a}, {k, b}})
            if (on_side(on, p))
                throw std::runtime_error(fmt::format(
                    "expected a polygon that does not meet itself, got the point {} on another side", text_of(p)));
        if (turn(i, c) * turn(i, d) >= 0 || turn(k, a) * turn(k, b) >= 0) return;
        const Vec2 where = a + (b - a) * (cross(c - a, d - c) / cross(b - a, d - c));
        throw std::runtime_error(
            fmt::format("expected a polygon that does not meet itself, got sides that cross at ({:.6g}, {:.6g})",
                        where.x, where.y));
    }

    std::vector<Vec2> points_;  // corners only, counter-clockwise
    double extent_ = 0;
};

// Builds the Boolean formula of a polygon's half-planes.
class Formula {
public:
    Formula(const Polygon& polygon, PrismAxis axis) : polygon_(polygon), axis_(axis) {}

    Density half_space(std::size_t i) const {
        const Vec2 side = polygon_.side(i), n = unit(Vec2(side.y, -side.x)), p = polygon_.point(i);
        return Density::half_space(raised(n), glm::dot(n, p) + 0.0);
    }

    Density whole() const {
        // Cut at the least and the greatest point: the extended sides there run in opposite directions and do not meet.
        std::size_t greatest = 0;
        for (std::size_t i = 1; i < polygon_.size(); ++i)
            if (before(polygon_.point(greatest), polygon_.point(i))) greatest = i;
        return chain(0, greatest - 1) & chain(greatest, polygon_.size() - 1);
    }

    /// The box around the polygon, enlarged so that rounding does not touch it.
    Density around() const {
        Vec2 lo(infinity), hi(-infinity);
        for (std::size_t i = 0; i < polygon_.size(); ++i) {
            lo = glm::min(lo, polygon_.point(i));
            hi = glm::max(hi, polygon_.point(i));
        }
        return Density::cover(raised({1, 0}), hi.x) & Density::cover(raised({-1, 0}), 0.0 - lo.x) &
               Density::cover(raised({0, 1}), hi.y) & Density::cover(raised({0, -1}), 0.0 - lo.y);
    }

    // The region that the sides first … last bound, with the first and the last one extended to infinity.
    Density chain(std::size_t first, std::size_t last) const {
        if (first == last) return half_space(first);
        const std::size_t corner = hull_corner(first, last);
        Density a = chain(first, corner - 1), b = chain(corner, last);
        return polygon_.turns_left(corner) ? std::move(a) & std::move(b) : std::move(a) | std::move(b);
    }

    Vec3 raised(Vec2 v) const {
        switch (axis_) {
            case PrismAxis::x: return {0, v.x, v.y};
            case PrismAxis::y: return {v.x, 0, v.y};
            default: return {v.x, v.y, 0};
        }
    }

    Vec3 along() const {
        Vec3 v(0);
        v[int(axis_)] = 1;
        return v;
    }

private:
    // The side after the first one whose start is a corner of the hull of all these sides: the farthest start in a
    // direction in which neither extended end runs.
    std::size_t hull_corner(std::size_t first, std::size_t last) const {
        const Vec2 back = -glm::normalize(polygon_.side(first)), forth = glm::normalize(polygon_.side(last));
        const Vec2 sum = back + forth;
        constexpr double opposite = 1e-12;
        const Vec2 away = glm::length(sum) > opposite ? -sum : Vec2(-back.y, back.x);
        std::size_t corner = first + 1;
        double most = glm::dot(away, polygon_.point(corner));
        for (std::size_t i = corner + 1; i <= last; ++i)
            if (const double far = glm::dot(away, polygon_.point(i)); far > most) {
                most = far;
                corner = i;
            }
        return corner;
    }

    const Polygon& polygon_;
    const PrismAxis axis_;
};

}  // namespace

Density prism(const std::vector<Vec2>& points, double low, double high, PrismAxis axis) {
    if (!(low < high)) throw std::runtime_error(fmt::format("expected low < high, got {} and {}", low, high));
    const Polygon polygon(points);
    const Formula formula(polygon, axis);
    const Density top = Density::half_space(formula.along(), high);
    const Density bottom = Density::half_space(-formula.along() + Vec3(0.0), -low + 0.0);
    if (polygon.convex()) {
        std::vector<Density> faces{top, bottom};
        for (std::size_t i = 0; i < polygon.size(); ++i) faces.push_back(formula.half_space(i));
        return Density::product(faces);
    }
    return formula.whole() & formula.around() & (top & bottom);
}

Density raised_polygon(const std::vector<Vec2>& points, PrismAxis axis) {
    const Polygon polygon(points);
    return Formula(polygon, axis).whole();
}

}  // namespace deburr
