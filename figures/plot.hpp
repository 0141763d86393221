// Line plots, drawings in the plane and 2-D fields with axes and labels, in one house style, as SVG
// and PNG. Drawn by gnuplot, which is called as a program.
//
// Texts are gnuplot's enhanced ones: h_{−r} is a subscript, x^2 a superscript, {/:Italic x} slanted;
// write \_ for a plain underscore. Points with a NaN break a line.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "bounds/vec.hpp"

namespace deburr {

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
constexpr const char* shade = "#dce6f0";  // inside of a body
}  // namespace house

struct Curve {
    enum class Kind { line, points, points_and_line, fill };
    std::vector<Vec2> points = {};
    std::string title = {};  // in the legend; "": not there
    std::string color = house::blue;
    Kind kind = Kind::line;
    double width = 2;       // of the line or of points; fill: of its outline, 0 for none
    std::string dash = {};  // "": solid, "-" dashed, "." dotted, "-." both
    double opacity = 1;     // fill
};

/// Points around a circle, closed.
std::vector<Vec2> circle(Vec2 center, double radius, int steps = 128);

struct Label {
    enum class Align { left, center, right };
    Vec2 at{0.0};
    std::string text = {};
    Align align = Align::left;
    std::string color = house::ink;
    double size = house::font_size;
};

struct Arrow {
    Vec2 from{0.0}, to{0.0};
    bool both_ends = false;
    std::string color = house::ink;
    double width = 1.5;
};

/// Values of a function over a rectangle, at the middles of columns × rows cells, from the lower left
/// corner, row by row; and lines where they reach `contours`.
struct PlotField {
    Vec2 lo{0.0}, hi{1.0};
    int columns = 0, rows = 0;
    std::vector<double> values = {};
    double least = 0, greatest = 1;  // ends of the colour scale
    std::string label = {};          // beside the scale
    std::vector<double> contours = {};
    std::string contour_color = house::ink;
};

struct Plot {
    int width = 640, height = 420;  // CSS pixels; the PNG has twice as many
    std::string title = {};
    std::string x_label = {}, y_label = {};
    std::optional<Vec2> x_range = {}, y_range = {};
    std::vector<double> x_ticks = {};  // empty: as gnuplot likes
    bool log_x = false, log_y = false;
    bool equal_units = false;          // a circle looks round
    bool axes = true;                  // false: a drawing without a frame
    std::string legend = "top right";  // "": none; "top left", "bottom right", "outside", …
    std::optional<PlotField> field = {};
    std::vector<Curve> curves = {};  // later ones over earlier ones
    std::vector<Arrow> arrows = {};
    std::vector<Label> labels = {};
};

/// A drawing: no axes, no legend, equal units.
inline Plot drawing(int width, int height) {
    Plot plot;
    plot.width = width;
    plot.height = height;
    plot.equal_units = true;
    plot.axes = false;
    plot.legend = "";
    return plot;
}

struct PlotImages {
    std::string svg, png;  // the files' bytes
};

/// Throws UnsupportedError if there is no gnuplot, WorkError if it fails.
PlotImages draw(const Plot& plot);

/// Throws UnsupportedError, and says what to install, if there is no gnuplot.
void require_gnuplot();

/// What gnuplot is told, but for terminal and output; for tests.
std::string gnuplot_script(const Plot& plot);

}  // namespace deburr
