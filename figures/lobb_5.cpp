// Lobb, figure 5: an edge rounded in three ways.
#include "bounds/rounded_edge.hpp"
#include "figures/figure.hpp"
#include "figures/plot.hpp"

namespace deburr {
namespace {

constexpr int steps = 400;  // of a curve, on either side

double radians(double degrees) { return glm::radians(degrees); }

std::vector<Vec2> curve(const SectionCurve& y, double width) {
    std::vector<Vec2> points;
    for (int k = -steps; k <= steps; ++k) points.push_back({width * k / steps, y(width * k / steps)});
    return points;
}

Plot section(double degrees) {
    const RoundedEdge edge(radians(degrees));
    const double half = radians(degrees / 2), s = std::sin(half);
    // The width of the picture: the part of the planes where the curves leave them.
    const double along = 1.25 * edge.quasi_reach(), width = along * s, bottom = edge.plane(width);
    Plot plot = drawing(400, 430);
    // A square picture with the section in its middle.
    const double center_y = -edge.exact_reach() / std::cos(half);
    const double lowest = std::min(bottom, center_y), size = std::max(2 * width, 0.12 - lowest) * 1.06;
    plot.x_range = Vec2(-size / 2, size / 2);
    plot.y_range = Vec2(0.5 * (lowest + 0.1) - size / 2, 0.5 * (lowest + 0.1) + size / 2);

    // The fillet's shaded region ends where it touches the planes.
    const double touch = edge.exact_reach() * s;
    const Vec2 center{0, center_y}, left{-touch, edge.plane(touch)}, right{touch, edge.plane(touch)};
    std::vector<Vec2> sector = curve([&](double x) { return edge.fillet(x); }, touch);
    sector.push_back(center);
    sector.push_back(sector.front());
    plot.curves.push_back({.points = sector, .color = house::shade, .kind = Curve::Kind::fill, .width = 0});
    plot.curves.push_back({.points = {left, center, right}, .color = house::grey, .width = 1.1, .dash = "."});
    plot.curves.push_back({.points = {{-width, bottom}, {0, 0}, {width, bottom}}, .color = house::ink, .width = 1.1});
    plot.curves.push_back(
        {.points = curve([&](double x) { return edge.quasi(x); }, width), .color = house::blue, .width = 3.2});
    plot.curves.push_back({.points = curve([&](double x) { return edge.fillet(x); }, touch),
                           .color = house::ink,
                           .width = 1.8,
                           .dash = "."});
    plot.curves.push_back({.points = curve([&](double x) { return edge.exact(x); }, width),
                           .color = house::red,
                           .width = 2,
                           .dash = "-"});
    for (const double side : {-1.0, 1.0})
        plot.curves.push_back({.points = circle({side * touch, edge.plane(touch)}, 0.008 * size, 24),
                               .color = house::ink,
                               .kind = Curve::Kind::fill,
                               .width = 0});
    plot.labels.push_back({.at = Vec2(-0.46, 0.43) * size + Vec2(0, 0.5 * (lowest + 0.1)),
                           .text = fmt::format("{:g}°", degrees),
                           .size = 15});
    if (degrees == 30) {  // only there is room between the curves
        const auto name = [&](double y, const char* text, const char* color) {
            plot.labels.push_back({.at = {0, y - 0.035 * size},
                                   .text = text,
                                   .align = Label::Align::center,
                                   .color = color,
                                   .size = 9.5});
        };
        name(edge.quasi(0), "quasi", house::blue);
        name(edge.exact(0), "truth", house::red);
        name(edge.fillet(0), "fillet", house::ink);
    }
    return plot;
}

void make(FigureContext& context) {
    context.columns(3);
    FigureTable table{{"angle", "quasi – truth", "truth – fillet", "quasi – fillet", "below the edge: quasi", "truth",
                       "fillet", "leaves the plane at: quasi", "truth, fillet"},
                      {}};
    std::vector<EdgeDistances> found;
    for (const double degrees : {90.0, 30.0, 135.0}) {
        const RoundedEdge edge(radians(degrees));
        const EdgeDistances a = distances(edge);
        found.push_back(a);
        context.plot(section(degrees),
                     fmt::format("{:g}°: quasi-convolution and truth {:.3f} r apart", degrees, a.quasi_exact));
        const auto r = [](double length) { return fmt::format("{:.4f} r", length); };
        table.rows.push_back({fmt::format("{:g}°", degrees), r(a.quasi_exact), r(a.exact_fillet), r(a.quasi_fillet),
                              r(-edge.quasi(0)), r(-edge.exact(0)), r(-edge.fillet(0)), r(edge.quasi_reach()),
                              r(edge.exact_reach())});
    }
    context.table(table);
    context.measured(
        fmt::format("At 90° the three are within {:.3f} r of each other. The true convolution is within {:.3f} r of "
                    "the fillet at 90° and {:.3f} r at "
                    "135°, but {:.2f} r off it at 30°, where quasi-convolution comes nearest to the edge, then truth, "
                    "then the fillet. At 135° "
                    "quasi-convolution leaves the planes {:.2f} r from the edge, the others at 1 r; at 179.9° it is "
                    "{:.3f} r inside.",
                    std::max({found[0].quasi_exact, found[0].exact_fillet, found[0].quasi_fillet}),
                    found[0].exact_fillet, found[2].exact_fillet, found[1].exact_fillet,
                    RoundedEdge(radians(135)).quasi_reach(), distances(RoundedEdge(radians(179.9))).quasi_exact));
}

const RegisteredFigure registered{{
    .name = "lobb-5",
    .title = "Figure 5: rounded intersecting half-spaces at angles of 90°, 30° and 135°",
    .shows =
        "Blue and heavy the quasi-convolution, red and dashed the true convolution, shaded and dotted the cylindrical "
        "fillet that meets the planes (dots) where the true convolution does, with the radii to its centre.",
    .claim =
        "All three are virtually equivalent at right angles; the true convolution is virtually indistinguishable from "
        "the "
        "fillet at 90° and 135°; at 30° quasi-convolution is pointier than truth, and truth than the fillet; for "
        "obtuse "
        "angles it reaches further than a radius, and in the limit lies about a quarter of the radius inside (§2.3.1).",
    .plots = true,
    .seconds = 3,
    .make = make,
}};

}  // namespace
}  // namespace deburr
