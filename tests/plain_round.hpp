// Random Boolean densities with round parts, together with their plain definition [docs/design.md, Round primitives]:
// every family of surfaces draws once, and the probabilities of all outcomes are summed. The plain definition shares no
// code with the code under test.
#pragma once
#include <cmath>
#include <functional>
#include <vector>

#include "bounds/density.hpp"
#include "random_case.hpp"

namespace deburr::test {

inline double plain_profile(double alpha) {
    if (alpha >= 1) return 0;
    if (alpha <= -1) return 1;
    return (1 - alpha) * (1 - alpha) * (2 + alpha) / 4;
}

class PlainRound {
public:
    /// Coordinate of x that a family of surfaces compares with limits: a distance from a point, an axis or a plane.
    using Coordinate = std::function<double(Vec3)>;
    /// Adds a family that draws around this coordinate and returns its index.
    int family(Coordinate u) {
        families_.push_back(std::move(u));
        return int(families_.size()) - 1;
    }
    /// Each of these adds an expression and returns its index: true where the family's draw is at most `limit`; a and
    /// b; a or b; not a.
    int at_most(int family, double limit) { return add({Op::at_most, family, -1, limit}); }
    int both(int a, int b) { return add({Op::both, a, b, 0}); }
    int either(int a, int b) { return add({Op::either, a, b, 0}); }
    int no(int a) { return add({Op::no, a, -1, 0}); }

    /// Density at x: the probability that the expression added last is true.
    double density(Vec3 x, double radius) const {
        std::vector<double> draw(families_.size(), 0);
        return sum(0, x, radius, draw);
    }
    /// True if x is in the sharp set, that of radius 0.
    bool contains(Vec3 x) const {
        std::vector<double> draw;
        for (const Coordinate& u : families_) draw.push_back(u(x));
        return holds(int(nodes_.size()) - 1, draw);
    }

private:
    enum class Op { at_most, both, either, no };
    struct Node {
        Op op;
        int a, b;
        double limit;
    };
    int add(Node n) {
        nodes_.push_back(n);
        return int(nodes_.size()) - 1;
    }
    bool holds(int i, const std::vector<double>& draw) const {
        const Node& n = nodes_[i];
        switch (n.op) {
            case Op::at_most: return draw[n.a] <= n.limit;
            case Op::both: return holds(n.a, draw) && holds(n.b, draw);
            case Op::either: return holds(n.a, draw) || holds(n.b, draw);
            default: return !holds(n.a, draw);
        }
    }
    double sum(int f, Vec3 x, double radius, std::vector<double>& draw) const {
        if (f == int(families_.size())) return holds(int(nodes_.size()) - 1, draw);
        std::vector<double> limits;
        for (const Node& n : nodes_)
            if (n.op == Op::at_most && n.a == f) limits.push_back(n.limit);
        std::sort(limits.begin(), limits.end());
        const double u = families_[f](x);
        double total = 0, below = 0;
        for (std::size_t gap = 0; gap <= limits.size(); ++gap) {
            const double F = gap < limits.size() ? plain_profile((u - limits[gap]) / radius) : 1;
            const double p = F - below;
            below = F;
            if (!(p > 0)) continue;
            draw[f] = gap < limits.size() ? limits[gap] : limits.empty() ? 0 : limits.back() + 1;
            if (gap > 0 && gap < limits.size() && limits[gap] == limits[gap - 1]) continue;
            total += p * sum(f + 1, x, radius, draw);
        }
        return total;
    }

    std::vector<Coordinate> families_;
    std::vector<Node> nodes_;
};

/// One density as a Density and in its plain definition.
struct RoundCase {
    Density density;
    PlainRound plain;
    double radius;
};

/// Makes random cases in which concentric, coaxial and flush parts are as frequent as others.
class RoundGen {
public:
    RoundGen(Gen& g, double radius) : g_(g), radius_(radius) {
        center_ = g.point(0.4);
        axis_ = g.chance(0.5) ? Vec3(0, 1, 0) : g.direction();
        slope_ = g.between(0.2, 1.2) * (g.chance(0.5) ? 1 : -1);
        ring_ = g.between(0.5, 1.0);
    }

    RoundCase make(int parts) {
        Density d = part();
        d = d & d;  // makes a single part a Boolean density too
        int e = plain_;
        while (--parts > 0) {
            const Density next = part();
            const int n = plain_;
            switch (g_.below(3)) {
                case 0:
                    d = d | next;
                    e = of_.either(e, n);
                    break;
                case 1:
                    d = d & ~next;
                    e = of_.both(e, of_.no(n));
                    break;
                default: d = d & next; e = of_.both(e, n);
            }
        }
        if (g_.chance(0.1)) {
            d = ~d;
            of_.no(e);
        }
        return {d, of_, radius_};
    }

private:
    // Index of the family with this key in `all`; a new one is made by `make` if there is none.
    template <class Make>
    int known(std::vector<std::pair<Vec3, int>>& all, Vec3 key, Make make) {
        for (const auto& [of, family] : all)
            if (of == key) return family;
        all.push_back({key, of_.family(make())});
        return all.back().second;
    }
    int point_family(Vec3 c) {
        return known(points_, c, [=] { return [=](Vec3 x) { return glm::distance(x, c); }; });
    }
    int cylinder_family(Vec3 c) {
        return known(cylinders_, c,
                     [=, this] { return [=, axis = axis_](Vec3 x) { return glm::length(glm::cross(axis, x - c)); }; });
    }
    int plane_family(Vec3 n) {
        return known(planes_, n, [=] { return [=](Vec3 x) { return glm::dot(n, x); }; });
    }
    int within(int family, double limit) {  // `family` is a distance, compared with [−limit, limit]
        return of_.both(of_.at_most(family, limit), of_.no(of_.at_most(family, -limit)));
    }
    // Half-spaces with opposite normals belong to one family of planes.
    int half_space(Vec3 n, double offset) {
        for (const auto& [of, family] : planes_)
            if (of == -n) return of_.no(of_.at_most(family, -offset));
        return of_.at_most(plane_family(n), offset);
    }
    int beyond(Vec3 n, double offset) { return of_.no(half_space(n, offset)); }

    Density part() {
        const double R = g_.chance(0.3) ? 0.4 : g_.chance(0.3) ? radius_ * g_.between(0.2, 1.5) : g_.between(0.1, 0.9);
        const Vec3 c = g_.chance(0.6) ? center_ : g_.point(0.5);
        switch (g_.below(6)) {
            case 0: plain_ = within(point_family(c), R); return Density::sphere(c, R);
            case 1: {
                const double low = g_.chance(0.4) ? -0.3 : g_.between(-0.8, 0),
                             high = g_.chance(0.4) ? 0.5 : g_.between(0.1, 1);
                const double at = glm::dot(axis_, c);
                plain_ = of_.both(within(cylinder_family(c), R),
                                  of_.both(half_space(axis_, at + high), beyond(axis_, at + low)));
                return g_.chance(0.5) ? Density::cylinder(c + low * axis_, c + high * axis_, R)
                                      : Density::cylinder(c + high * axis_, c + low * axis_, R);
            }
            case 2: {  // all cones have one slope and one axis direction; those with the same c are parallel
                const double across = 1 / std::hypot(1.0, slope_), along = slope_ / std::hypot(1.0, slope_);
                const double low = -0.4, widest = R, high = g_.chance(0.4) ? 10 : g_.between(0.1, 0.6);
                const double end = widest - slope_ * (high - low);
                const double at = glm::dot(axis_, c), limit = across * widest;
                const Vec3 from = c + low * axis_, axis = axis_;
                const int out = known(cones_, c, [&] {
                    return [=](Vec3 x) {
                        const Vec3 y = x - from;
                        return across * glm::length(glm::cross(axis, y)) + along * glm::dot(axis, y);
                    };
                });
                const int back = known(mirrored_, c, [&] {
                    return [=](Vec3 x) {
                        const Vec3 y = x - from;
                        return -across * glm::length(glm::cross(axis, y)) + along * glm::dot(axis, y);
                    };
                });
                const int nappe = of_.both(of_.at_most(out, limit), of_.at_most(back, limit));
                if (end <= 0) {  // the cone ends at its apex
                    plain_ = of_.both(nappe, beyond(axis_, at + low));
                    return Density::cone(from, from + axis * (widest / slope_), widest, 0);
                }
                plain_ = of_.both(nappe, of_.both(beyond(axis_, at + low), half_space(axis_, at + high)));
                return Density::cone(from, c + axis * high, widest, end);
            }
            case 3: {
                const double ring = std::max(ring_, 0.3 + radius_), tube = g_.between(0.2, 1) * (ring - radius_);
                const Vec3 axis = axis_, center = center_;
                const int family = known(tori_, center, [&] {
                    return [=](Vec3 x) {
                        const Vec3 y = x - center;
                        return std::hypot(glm::length(glm::cross(axis, y)) - ring, glm::dot(axis, y));
                    };
                });
                plain_ = within(family, tube);
                return Density::torus(center, axis, ring, tube);
            }
            default: {
                const Vec3 n = g_.chance(0.5) ? axis_ : g_.normal();
                const double offset = g_.between(-0.5, 0.7);
                plain_ = half_space(n, offset);
                return Density::half_space(n, offset);
            }
        }
    }

    Gen& g_;
    double radius_;
    Vec3 center_, axis_;
    double slope_, ring_;
    PlainRound of_;
    int plain_ = -1;
    std::vector<std::pair<Vec3, int>> points_, cylinders_, planes_, cones_, mirrored_, tori_;
};

/// A random Boolean density of `parts` parts; its filter radius is from 10⁻⁴ to 10⁻¹ in a fifth of the cases, else from
/// 0.05 to 0.6.
inline RoundCase round_case(Gen& g, int parts) {
    const double radius = g.chance(0.2) ? std::pow(10.0, g.between(-4, -1)) : g.between(0.05, 0.6);
    return RoundGen(g, radius).make(parts);
}

}  // namespace deburr::test
