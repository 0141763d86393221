#include "bounds/rounded_edge.hpp"

#include <algorithm>

namespace deburr {
namespace {

using Vec2 = glm::dvec2;

/// The wedge of this dihedral angle, below its edge at the origin.
Density wedge(double angle) {
    const double c = std::cos(angle / 2), s = std::sin(angle / 2);
    return Density::half_space({c, s, 0}, 0) * Density::half_space({-c, s, 0}, 0);
}

// The greatest distance of a point of the polyline `from` with 0 ≤ x ≤ width from the polyline `to`, whose points have
// the same x.
double one_way(const std::vector<Vec2>& from, const std::vector<Vec2>& to, double width) {
    double most = 0;
    for (std::size_t i = 0; i < from.size(); ++i) {
        if (from[i].x < 0 || from[i].x > width) continue;
        // Segments of `to` are visited outwards from the same x, until none can be nearer.
        double least = glm::length(from[i] - to[i]);
        for (std::size_t k = i; k + 1 < to.size() && to[k].x - from[i].x < least; ++k)
            least = std::min(least, distance_to_segment(from[i], to[k], to[k + 1]));
        for (std::size_t k = i; k > 0 && from[i].x - to[k].x < least; --k)
            least = std::min(least, distance_to_segment(from[i], to[k - 1], to[k]));
        most = std::max(most, least);
    }
    return most;
}

}  // namespace

RoundedEdge::RoundedEdge(double angle)
    : angle_(angle), quasi_(flatten(wedge(angle), 1)), exact_(flatten_convolved(wedge(angle), 1)) {}

double RoundedEdge::plane(double x) const { return -std::abs(x) / std::tan(angle_ / 2); }

// The y at which the density is ½. The density rises downwards, to 1 at a radius from both planes.
double RoundedEdge::depth(const LocalDensity& density, double x) const {
    double above = plane(x), below = above - 1 / std::sin(angle_ / 2);
    if (density.at({x, above, 0}) >= 0.5 - 1e-15) return above;
    for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (above + below);
        (density.at({x, middle, 0}) >= 0.5 ? below : above) = middle;
    }
    return 0.5 * (above + below);
}

double RoundedEdge::quasi(double x) const { return depth(quasi_, x); }
double RoundedEdge::exact(double x) const { return depth(exact_, x); }

double RoundedEdge::fillet(double x) const {
    if (std::abs(x) >= exact_reach() * std::sin(angle_ / 2)) return plane(x);
    const double r = fillet_radius();
    return std::sqrt(r * r - x * x) - exact_reach() / std::cos(angle_ / 2);
}

double distance_between(const SectionCurve& a, const SectionCurve& b, double width, int steps) {
    std::vector<Vec2> of_a, of_b;
    for (int k = -steps / 4; k <= steps + steps / 4; ++k) {  // beyond the ends, too, where the nearest point may lie
        const double x = width * k / steps;
        of_a.push_back({x, a(std::abs(x))});
        of_b.push_back({x, b(std::abs(x))});
    }
    return std::max(one_way(of_a, of_b, width), one_way(of_b, of_a, width));
}

EdgeDistances distances(const RoundedEdge& edge, int steps) {
    const SectionCurve quasi = [&](double x) { return edge.quasi(x); };
    const SectionCurve exact = [&](double x) { return edge.exact(x); };
    const SectionCurve fillet = [&](double x) { return edge.fillet(x); };
    const double w = edge.width();
    return {distance_between(quasi, exact, w, steps), distance_between(exact, fillet, w, steps),
            distance_between(quasi, fillet, w, steps)};
}

}  // namespace deburr
