// Triage, figure 5: what one smoothed half-space makes of space.
#include "bounds/profile.hpp"
#include "figures/figure.hpp"
#include "figures/plot.hpp"

namespace deburr {
namespace {

void make(FigureContext& context) {
    constexpr double r = 1, half_height = 1.05, half_width = 2.2;
    Plot plot = drawing(640, 300);
    plot.x_range = Vec2(-half_width, half_width);
    plot.y_range = Vec2(-half_height, half_height);
    PlotField field{.lo = {-half_width, -0.8}, .hi = {half_width, 0.8}, .columns = 440, .rows = 2};
    for (int j = 0; j < field.rows; ++j)
        for (int i = 0; i < field.columns; ++i)
            field.values.push_back(profile((field.lo.x + (i + 0.5) * (field.hi.x - field.lo.x) / field.columns) / r));
    plot.field = field;
    const auto plane = [&](double x, const char* name, const char* dash) {
        plot.curves.push_back({.points = {{x, -0.8}, {x, 0.8}}, .color = house::ink, .dash = dash});
        plot.labels.push_back({.at = {x, 0.92}, .text = name, .align = Label::Align::center, .size = 13});
    };
    plane(-r, "{/:Italic h}_{−{/:Italic r}}", "-");
    plane(0, "{/:Italic h}", "");
    plane(r, "{/:Italic h}_{/:Italic r}", "-");
    const auto region = [&](double x, const std::string& name, const std::string& range, const char* color) {
        plot.labels.push_back(
            {.at = {x, 0.1}, .text = name, .align = Label::Align::center, .color = color, .size = 13});
        plot.labels.push_back({.at = {x, -0.15}, .text = range, .align = Label::Align::center, .color = color});
    };
    region(-1.6, "one", fmt::format("{:g}", profile(-1.6)), "#ffffff");
    region(-0.5, "high", fmt::format("[{:g}, {:g}]", profile(0), profile(-1)), "#ffffff");
    region(0.5, "low", fmt::format("[{:g}, {:g})", profile(1), profile(0)), house::ink);
    region(1.6, "zero", fmt::format("{:g}", profile(1.6)), house::ink);
    context.plot(plot);
    context.measured(fmt::format("ρ is {:g}, {:g} and {:g} on the three planes.", profile(-1), profile(0), profile(1)));
}

const RegisteredFigure registered{{
    .name = "triage-5",
    .title = "Figure 5: a quasi-convolutionally smoothed half-space parts space into four regions",
    .shows = "The density of a half-space, dark inside, and the planes that the polyhedral subdivision cuts with.",
    .claim = "ρ is 1 on the inner plane, ½ on the half-space's own and 0 on the outer one; the regions between are "
             "one, high, low and zero (§4.2).",
    .plots = true,
    .seconds = 1,
    .make = make,
}};

}  // namespace
}  // namespace deburr
