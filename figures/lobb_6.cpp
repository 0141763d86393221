// Lobb, figure 6: the density across a smoothed half-space, and its square.
#include "bounds/profile.hpp"
#include "figures/figure.hpp"
#include "figures/plot.hpp"

namespace deburr {
namespace {

void make(FigureContext& context) {
    Plot plot;
    plot.width = 680;
    plot.height = 400;
    plot.x_label = "distance from the plane, filter radii";
    plot.y_label = "density";
    plot.x_range = Vec2(-1.5, 1.5);
    plot.y_range = Vec2(0, 1.08);
    plot.x_ticks = {-1.5, -1, -0.5, 0, 0.5, 1, 1.5};
    Curve density{.title = "one half-space, ρ", .color = house::blue, .width = 2.6};
    Curve square{.title = "two identical ones, ρ^2", .color = house::red, .width = 2.2, .dash = "-"};
    for (int k = 0; k <= 600; ++k) {
        const double x = -1.5 + 3.0 * k / 600, rho = profile(x);
        density.points.push_back({x, rho});
        square.points.push_back({x, rho * rho});
    }
    const double in = displacement(std::sqrt(0.5));
    plot.curves.push_back({.points = {{-1.5, 0.5}, {1.5, 0.5}}, .color = house::grey, .width = 1, .dash = "."});
    plot.curves.push_back({.points = {{in, 0}, {in, 0.5}}, .color = house::red, .width = 1, .dash = "."});
    plot.curves.push_back(density);
    plot.curves.push_back(square);
    for (const auto& [x, color] : {std::pair{0.0, house::blue}, std::pair{in, house::red}})
        plot.curves.push_back({.points = {{x, 0.5}}, .color = color, .kind = Curve::Kind::points, .width = 2});
    plot.labels.push_back({.at = {in - 0.04, 0.05},
                           .text = fmt::format("{:.3f}", in),
                           .align = Label::Align::right,
                           .color = house::red});
    plot.labels.push_back(
        {.at = {1.47, 0.525}, .text = "the surface", .align = Label::Align::right, .color = house::grey});
    context.plot(plot);
    context.measured(
        fmt::format("Squared, the density is ½ at {:.4f} radii: the surface of two identical half-spaces lies {:.2f} r "
                    "inside their plane.",
                    in, -in));
}

const RegisteredFigure registered{{
    .name = "lobb-6",
    .title = "Figure 6: the density variation across a smoothed half-space, and the density squared",
    .shows = "Blue the share of a ball on the inner side of a plane, over the distance of its centre; red and dashed "
             "its square, which "
             "is what a product of two identical half-spaces has.",
    .claim = "With a pair of identical half-spaces the entire isosurface is inside the planes by about one quarter of "
             "the filter radius (§2.3.1).",
    .plots = true,
    .seconds = 1,
    .make = make,
}};

}  // namespace
}  // namespace deburr
