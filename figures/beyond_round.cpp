// How far a true convolution would move round surfaces, which densities of a round coordinate leave where they are.
#include <cmath>

#include "bounds/profile.hpp"
#include "bounds/round_coordinate.hpp"
#include "figures/figure.hpp"
#include "figures/plot.hpp"

namespace deburr {
namespace {

// A round surface u = offset, a point on it, and the outward normal and mean curvature there.
struct Surface {
    RoundCoordinate coordinate;
    double offset;
    Vec3 at, normal;
    double curvature;
};

// The length of the part of the line x + z·direction, |z| ≤ half, that is inside; it begins inside, if at all, at
// −half.
double length_inside(const Surface& s, Vec3 x, Vec3 direction, double half) {
    const auto inside = [&](double z) { return s.coordinate.at(x + z * direction) <= s.offset; };
    if (!inside(-half)) return 0;
    if (inside(half)) return 2 * half;
    double in = -half, out = half;
    constexpr int halvings = 30;
    for (int i = 0; i < halvings; ++i) {
        const double middle = 0.5 * (in + out);
        (inside(middle) ? in : out) = middle;
    }
    return in + half;
}

// The share of a ball of radius r inside the surface, when its center is `distance` outside of it: an integral over
// lines along the normal.
double share(const Surface& s, double distance, double r) {
    const Vec3 u = glm::normalize(glm::cross(s.normal, std::abs(s.normal.x) < 0.5 ? Vec3(1, 0, 0) : Vec3(0, 1, 0)));
    const Vec3 v = glm::cross(s.normal, u), center = s.at + distance * s.normal;
    constexpr int rings = 40, spokes = 24;
    double volume = 0;
    for (int i = 0; i < rings; ++i) {
        // A ring of the disc; with ρ = r sin of an angle, half the line's length is r times its cosine, and smooth.
        const double angle = 0.5 * pi * (i + 0.5) / rings, rho = r * std::sin(angle), half = r * std::cos(angle);
        const double area = rho * r * std::cos(angle) * (0.5 * pi / rings) * (2 * pi / spokes);
        for (int k = 0; k < spokes; ++k) {
            const double turn = 2 * pi * (k + 0.5) / spokes;
            volume += area * length_inside(s, center + rho * (std::cos(turn) * u + std::sin(turn) * v), s.normal, half);
        }
    }
    return volume / (4 * pi / 3 * r * r * r);
}

// The distance from the surface at which the share is ½, in radii; negative: inward.
double shift(const Surface& s, double r) {
    double in = -0.6, out = 0.6;
    constexpr int halvings = 16;
    for (int i = 0; i < halvings; ++i) {
        const double middle = 0.5 * (in + out);
        (share(s, middle * r, r) > 0.5 ? in : out) = middle;
    }
    return 0.5 * (in + out);
}

Surface sphere() { return {RoundCoordinate::distance_from_point(Vec3(0.0)), 1, {1, 0, 0}, {1, 0, 0}, 1}; }
Surface cylinder() { return {RoundCoordinate::distance_from_axis(Vec3(0.0), {0, 0, 1}), 1, {1, 0, 0}, {1, 0, 0}, 0.5}; }
// A cone with half an angle of 30°, at the point where the distance from the axis along the normal is 1.
Surface cone() {
    const double a = std::cos(pi / 6), b = std::sin(pi / 6);
    return {RoundCoordinate::across_cone(Vec3(0.0), {0, 0, 1}, a, b), a * a, {a, 0, 0}, {a, 0, b}, 0.5};
}
// A torus with a ring of three times the tube's radius, at its outer equator.
Surface torus() {
    return {RoundCoordinate::distance_from_circle(Vec3(0.0), {0, 0, 1}, 3), 1, {4, 0, 0}, {1, 0, 0}, 0.5 * (1 + 0.25)};
}

void make(FigureContext& context) {
    Plot plot;
    plot.width = 760;
    plot.height = 420;
    plot.x_label = "filter radius, radii of curvature";
    plot.y_label = "shift of the surface, filter radii";
    plot.x_range = Vec2(0, 1);
    plot.y_range = Vec2(-0.35, 0.05);
    plot.x_ticks = {0, 0.05, 0.2, 0.5, 0.8, 1};
    plot.legend = "bottom left";
    struct Kind {
        const char* name;
        Surface surface;
        const char* color;
    };
    const Kind kinds[] = {{"sphere", sphere(), house::red},
                          {"torus, outer equator", torus(), house::amber},
                          {"cylinder", cylinder(), house::blue},
                          {"cone of 30°", cone(), house::green}};
    std::string told;
    for (const Kind& kind : kinds) {
        Curve exact{.title = std::string("true convolution, ") + kind.name, .color = kind.color, .width = 2.4};
        Curve second{.color = kind.color, .width = 1.2, .dash = "."};
        const bool is_cone = kind.surface.coordinate.is_cone();  // its apex is one radius of curvature away
        for (double r = 0.05; r <= (is_cone ? 0.8 : 1) + 1e-9; r += 0.05) {
            exact.points.push_back({r, shift(kind.surface, r)});
            second.points.push_back({r, -0.25 * kind.surface.curvature * r});
        }
        told += fmt::format("{}{}: {:.4f} r at r = R/20, {:.4f} r at R/5, {:.4f} r at R/2", told.empty() ? "" : "; ",
                            kind.name, exact.points[0].y, exact.points[3].y, exact.points[9].y);
        plot.curves.push_back(exact);
        plot.curves.push_back(second);
    }
    plot.curves.push_back(
        {.points = {{0, 0}, {1, 0}}, .title = "density of the distance", .color = house::ink, .width = 2.4});
    context.plot(plot);
    context.measured("Shift of the surface by true convolution, by quadrature: " + told +
                     ". Dotted: −H r²/4, with H the mean curvature. A density of the distance shifts nothing.");
}

const RegisteredFigure registered{{
    .name = "beyond-round",
    .title = "Round surfaces under true convolution, and under a density of the distance",
    .shows =
        "Where the level ½ of the exact share of a ball lies beside a sphere, a cylinder, a cone and a torus, over the "
        "filter's radius in units of the radius R of curvature.",
    .claim =
        "Smoothing of objects that are no polyhedra is an open question (Lobb §5, e). The profile of a signed distance "
        "keeps round things where they are, where the convolution makes them smaller.",
    .plots = true,
    .seconds = 10,
    .make = make,
}};

}  // namespace
}  // namespace deburr
