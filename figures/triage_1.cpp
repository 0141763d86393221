// Triage, figure 1: a convolutionally smoothed polygon.
#include "figures/figure.hpp"
#include "figures/plane_curves.hpp"

namespace deburr {
namespace {

void make(FigureContext& context) {
    const std::vector<Vec2> polygon = {{0, 0}, {4.2, 0}, {4.2, 1.1}, {2.9, 1.1}, {2.9, 2.8}, {1.6, 2.8}, {0, 1.5}};
    constexpr double r = 0.55;
    const auto share = [&](Vec2 x) { return disc_share(polygon, x, r); };
    const auto lines = level_lines(share, 0.5, {-0.5, -0.5}, {4.7, 3.3}, 208, 152);

    Plot plot = drawing(560, 400);
    plot.x_range = Vec2(-0.75, 4.95);
    plot.y_range = Vec2(-0.72, 3.35);
    std::vector<Vec2> outline = polygon;
    outline.push_back(outline.front());
    for (const auto& line : lines) {
        plot.curves.push_back({.points = line, .color = house::shade, .kind = Curve::Kind::fill, .width = 0});
        plot.curves.push_back({.points = line, .color = house::blue, .width = 2.5});
    }
    plot.curves.push_back({.points = outline, .color = house::ink, .width = 1.2, .dash = "-"});
    double worst = 0;
    std::size_t points = 0;
    for (const auto& line : lines)
        for (const Vec2& x : line) {
            worst = std::max(worst, std::abs(share(x) - 0.5));
            ++points;
        }
    // The test disc at three points of the outline.
    for (const double at : {0.13, 0.42, 0.73}) {
        const Vec2 x = lines.at(0)[at * double(lines[0].size())];
        plot.curves.push_back({.points = circle(x, r), .color = house::red, .width = 1.4});
        plot.curves.push_back({.points = circle(x, 0.035), .color = house::red, .kind = Curve::Kind::fill, .width = 0});
    }
    context.plot(plot);
    context.measured(fmt::format("At {} points of the outline the share of the disc inside is ½ to {:.0e}.", points,
                                 std::max(worst, 1e-16)));
}

const RegisteredFigure registered{{
    .name = "triage-1",
    .title = "Figure 1: a convolutionally smoothed polygon",
    .shows = "Dashed the polygon, blue its smoothed version, red the test disc at three points of it.",
    .claim = "The smoothed outline is where exactly half of the test volume lies inside the polygon (§2.1, after "
             "Colburn 1990).",
    .plots = true,
    .seconds = 1,
    .make = make,
}};

}  // namespace
}  // namespace deburr
