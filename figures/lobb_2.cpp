// Lobb, figure 2: a polygon smoothed by a circular filter.
#include "figures/figure.hpp"
#include "figures/plane_curves.hpp"

namespace deburr {
namespace {

// The part of the polygon inside a convex outline [Sutherland & Hodgman 1974].
std::vector<Vec2> clipped(std::vector<Vec2> polygon, const std::vector<Vec2>& outline) {
    for (std::size_t k = 0; k + 1 < outline.size() && !polygon.empty(); ++k) {
        const Vec2 a = outline[k], along = outline[k + 1] - a;
        std::vector<Vec2> rest;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const Vec2 p = polygon[i], q = polygon[(i + 1) % polygon.size()];
            const double at_p = cross(along, p - a), at_q = cross(along, q - a);
            if (at_p >= 0) rest.push_back(p);
            if ((at_p >= 0) != (at_q >= 0)) rest.push_back(p + at_p / (at_p - at_q) * (q - p));
        }
        polygon = std::move(rest);
    }
    return polygon;
}

// The signed distance, positive outside.
double distance(const std::vector<Vec2>& polygon, Vec2 x) {
    double least = infinity;
    bool inside = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()], d = b - a;
        least = std::min(least, glm::length(x - a - std::clamp(glm::dot(x - a, d) / glm::dot(d, d), 0.0, 1.0) * d));
        if ((a.y > x.y) != (b.y > x.y) && x.x < a.x + (x.y - a.y) / d.y * d.x) inside = !inside;
    }
    return inside ? -least : least;
}

void make(FigureContext& context) {
    const std::vector<Vec2> polygon = {{0, 0}, {5.4, 0}, {4.3, 1.35}, {2.5, 1.35}, {2.5, 3.2}, {1.1, 3.2}, {0, 2.0}};
    constexpr double r = 0.6;
    const auto share = [&](Vec2 x) { return disc_share(polygon, x, r); };
    const auto lines = level_lines(share, 0.5, {-0.5, -0.5}, {5.7, 3.7}, 310, 210);

    Plot plot = drawing(700, 480);
    plot.x_range = Vec2(-0.8, 6.0);
    plot.y_range = Vec2(-0.75, 3.9);
    for (const auto& line : lines)
        plot.curves.push_back({.points = line, .color = house::shade, .kind = Curve::Kind::fill, .width = 0});
    std::vector<Vec2> outline = polygon;
    outline.push_back(outline.front());

    double worst = 0, out = 0, in = 0;
    std::size_t points = 0;
    for (const auto& line : lines)
        for (const Vec2& x : line) {
            worst = std::max(worst, std::abs(share(x) - 0.5));
            out = std::max(out, distance(polygon, x));
            in = std::max(in, -distance(polygon, x));
            ++points;
        }
    // Circles where the outline is nearest to these points: corners, the notch and a side.
    double uneven = 0;
    for (const Vec2 near : {polygon[1], polygon[3], polygon[5], polygon[0], Vec2(2.9, 0), Vec2(-0.2, 1.4)}) {
        Vec2 c = lines.at(0)[0];
        for (const auto& line : lines)
            for (const Vec2& x : line)
                if (glm::length(x - near) < glm::length(c - near)) c = x;
        uneven = std::max(uneven, std::abs(share(c) - 0.5));
        plot.curves.push_back({.points = clipped(polygon, circle(c, r)),
                               .color = house::amber,
                               .kind = Curve::Kind::fill,
                               .width = 0,
                               .opacity = 0.45});
        plot.curves.push_back({.points = circle(c, r), .color = house::red, .width = 1.5});
        plot.curves.push_back({.points = circle(c, 0.035), .color = house::red, .kind = Curve::Kind::fill, .width = 0});
    }
    plot.curves.push_back({.points = outline, .color = house::ink, .width = 1.3, .dash = "-"});
    for (const auto& line : lines) plot.curves.push_back({.points = line, .color = house::blue, .width = 2.6});
    context.plot(plot);
    context.measured(
        fmt::format("Of the circles drawn, ½ lies inside the polygon to {:.0e}, and so at all {} points of the outline "
                    "to {:.0e}. The outline is "
                    "up to {:.2f} r within the polygon (at the sharpest corner) and up to {:.2f} r outside of it (in "
                    "the notch): both less "
                    "than r, and the second is why a ray that misses the polygon can hit its smoothed version (§2.1).",
                    std::max(uneven, 1e-16), points, std::max(worst, 1e-16), in / r, out / r));
}

const RegisteredFigure registered{{
    .name = "lobb-2",
    .title = "Figure 2: convolutional smoothing of a polygon by a circular filter",
    .shows = "Dashed the polygon, shaded its smoothed version, red the filter at points of the smoothed outline; "
             "amber is the half of it that lies inside the polygon.",
    .claim = "Half of each circle's area is inside the unsmoothed polygon (§2.1); the smoothed surface lies within one "
             "radius of the unsmoothed one (§3.2).",
    .plots = true,
    .seconds = 2,
    .make = make,
}};

}  // namespace
}  // namespace deburr
