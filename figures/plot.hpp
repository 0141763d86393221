// Line plots, drawings in the plane, and 2-D fields with axes and labels, in one style, as SVG and PNG, drawn by the
// program gnuplot.
//
// Texts are gnuplot's enhanced ones: h_{−r} is a subscript, x^2 a superscript, {/:Italic x} italic; \_ is a plain
// underscore. A point with NaN interrupts a line.
// write \_ for a plain underscore. Points with a NaN break a line.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "bounds/vec.hpp"

namespace deburr {

// The style: font and colours.
namespace house {
constexpr const char* font = "DejaVu Sans";
constexpr double font_size = 11;  // points
constexpr const char* ink = "#333333";
constexpr const char* grid = "#dddddd";
constexpr const char* grey = "#8c8c8c";
constexpr const char* blue = "#2c6fad";
constexpr const char* red = "#c4472b";
constexpr const char* green = "#3b8a57";
constexpr const char* amber = "#d99a1e";
constexpr const char* violet = "#7a5aa6";
constexpr const char* shade = "#dce6f0";  // interior of a body
}  // namespace house

/// A curve, a set of points, or a filled polygon.
struct Curve {
    enum class Kind { line, points, points_and_line, fill };
    std::vector<Vec2> points = {};
    std::string title = {};  // in the legend; "": not in it
    std::string color = house::blue;
    Kind kind = Kind::line;
    double width = 2;       // of the line or points; fill: of its outline, 0: none
    std::string dash = {};  // "": solid, "-": dashed, ".": dotted, "-.": dash-dotted
    double opacity = 1;     // of a fill
};

/// Points on a circle, closed.
std::vector<Vec2> circle(Vec2 center, double radius, int steps = 128);

/// A text at a point of the plot.
struct Label {
    enum class Align { left, center, right };
    Vec2 at{0.0};
    std::string text = {};
    Align align = Align::left;
    std::string color = house::ink;
    double size = house::font_size;
};

/// An arrow between points of the plot.
struct Arrow {
    Vec2 from{0.0}, to{0.0};
    bool both_ends = false;
    std::string color = house::ink;
    double width = 1.5;
};

/// A function sampled over the rectangle [lo, hi], at the centers of columns × rows cells, row by row from the lower
/// left; with contour lines at the values `contours`.
struct PlotField {
    Vec2 lo{0.0}, hi{1.0};
    int columns = 0, rows = 0;
    std::vector<double> values = {};
    double least = 0, greatest = 1;  // ends of the colour scale
    std::string label = {};          // of the colour scale
    std::vector<double> contours = {};
    std::string contour_color = house::ink;
};

/// A plot with its curves.
struct Plot {
    int width = 640, height = 420;  // CSS pixels; the PNG has twice as many
    std::string title = {};
    std::string x_label = {}, y_label = {};
    std::optional<Vec2> x_range = {}, y_range = {};
    std::vector<double> x_ticks = {};  // empty: gnuplot's choice
    bool log_x = false, log_y = false;
    bool equal_units = false;          // equal scales on both axes
    bool axes = true;                  // false: a drawing without a frame
    std::string legend = "top right";  // position: "top left", "bottom right", "outside", …; "": none
    std::optional<PlotField> field = {};
    std::vector<Curve> curves = {};  // drawn in order
    std::vector<Arrow> arrows = {};
    std::vector<Label> labels = {};
};

/// A plot for drawings: without axes and legend, with equal scales.
inline Plot drawing(int width, int height) {
    Plot plot;
    plot.width = width;
    plot.height = height;
    plot.equal_units = true;
    plot.axes = false;
    plot.legend = "";
    return plot;
}

/// A plot in both formats.
struct PlotImages {
    std::string svg, png;  // bytes of the files
};

/// Draws the plot. Throws UnsupportedError if gnuplot is not installed, WorkError if it fails.
PlotImages draw(const Plot& plot);

/// Throws UnsupportedError, with what to install, if gnuplot is not installed.
void require_gnuplot();

/// The gnuplot script without terminal and output; for tests.
std::string gnuplot_script(const Plot& plot);

}  // namespace deburr
