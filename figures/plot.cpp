#include "figures/plot.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>

#include "figures/gnuplot.hpp"

namespace deburr {
namespace {

// The text in gnuplot's single quotes, in which only a quote is special and no newline is allowed.
std::string quoted(const std::string& text) {
    std::string out = "'";
    for (const char c : text) {
        if (c == '\'')
            out += "''";
        else
            out += c == '\n' ? ' ' : c;
    }
    return out + "'";
}

// Clips a polygon to the plot's ranges, since gnuplot draws areas beyond them wrongly [Sutherland & Hodgman 1974].
std::vector<Vec2> clipped(std::vector<Vec2> polygon, const Plot& plot) {
    for (int side = 0; side < 4; ++side) {
        const int k = side / 2;
        const auto& range = k == 0 ? plot.x_range : plot.y_range;
        if (!range) continue;
        const double bound = side % 2 ? range->y : range->x, sign = side % 2 ? -1 : 1;
        std::vector<Vec2> kept;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const Vec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
            const double da = sign * (a[k] - bound), db = sign * (b[k] - bound);
            if (da >= 0) kept.push_back(a);
            if ((da < 0) != (db < 0)) kept.push_back(glm::mix(a, b, da / (da - db)));
        }
        polygon = std::move(kept);
    }
    if (!polygon.empty()) polygon.push_back(polygon.front());  // otherwise one side would have no outline
    return polygon;
}

std::string data_of(const Curve& curve, const Plot& plot) {
    std::string out;
    for (const Vec2& p : curve.kind == Curve::Kind::fill ? clipped(curve.points, plot) : curve.points)
        out += std::isfinite(p.x) && std::isfinite(p.y) ? fmt::format("{:.10g} {:.10g}\n", p.x, p.y) : "\n";
    return out;
}

std::string style_of(const Curve& c) {
    const std::string dash = c.dash.empty() ? "" : " dashtype " + quoted(c.dash);
    const std::string line = fmt::format("linecolor rgb {} linewidth {}{}", quoted(c.color), c.width, dash);
    switch (c.kind) {
        case Curve::Kind::line: return "with lines " + line;
        case Curve::Kind::points:
            return fmt::format("with points pointtype 7 pointsize {} linecolor rgb {}", 0.3 * c.width, quoted(c.color));
        case Curve::Kind::points_and_line: return "with linespoints pointtype 7 pointsize 0.6 " + line;
        case Curve::Kind::fill:
            return fmt::format("with filledcurves closed fillcolor rgb {} fillstyle {} {}", quoted(c.color),
                               c.opacity < 1 ? fmt::format("transparent solid {}", c.opacity) : "solid 1",
                               c.width > 0
                                   ? fmt::format("border linecolor rgb {} linewidth {}", quoted(house::ink), c.width)
                                   : "noborder");
    }
    return {};
}

std::string script_of(const PlotField& f) {
    const Vec2 step = (f.hi - f.lo) / Vec2(f.columns, f.rows);
    std::string out = "$field << EOD\n";
    for (int j = 0; j < f.rows; ++j) {
        for (int i = 0; i < f.columns; ++i)
            out += fmt::format("{:.8g} {:.8g} {:.8g}\n", f.lo.x + (i + 0.5) * step.x, f.lo.y + (j + 0.5) * step.y,
                               f.values[std::size_t(j) * std::size_t(f.columns) + std::size_t(i)]);
        out += "\n";
    }
    out += "EOD\n";
    out += fmt::format("set cbrange [{}:{}]\n", f.least, f.greatest);
    // From white (empty space) to deep blue, with even steps of lightness.
    out += "set palette defined (0 '#ffffff', 0.25 '#d3e2ef', 0.5 '#8fb8d9', 0.75 '#4c86bd', 1 '#1f4e84')\n";
    if (f.label.empty())
        out += "unset colorbox\n";
    else
        out += "set cblabel " + quoted(f.label) + "\nset cbtics nomirror\n";
    if (f.contours.empty()) return out;
    out += "set contour base\nunset surface\nset cntrparam levels discrete ";
    for (std::size_t i = 0; i < f.contours.size(); ++i) out += fmt::format("{}{}", i ? "," : "", f.contours[i]);
    return out + "\nset table $contours\nsplot $field using 1:2:3 notitle\nunset table\nunset contour\n";
}

const char* word_of(Label::Align align) {
    return align == Label::Align::left ? "left" : align == Label::Align::right ? "right" : "center";
}

}  // namespace

std::vector<Vec2> circle(Vec2 center, double radius, int steps) {
    std::vector<Vec2> points;
    for (int i = 0; i <= steps; ++i) {
        const double angle = 2 * pi * (i % steps) / steps;
        points.push_back(center + radius * Vec2(std::cos(angle), std::sin(angle)));
    }
    return points;
}

std::string gnuplot_script(const Plot& p) {
    std::string s = "set encoding utf8\nset clip one\nset clip two\n";
    s += fmt::format("set border 3 linecolor rgb {} linewidth 1\n", quoted(house::ink));
    s += fmt::format("set tics nomirror out scale 0.6 textcolor rgb {}\n", quoted(house::ink));
    if (p.axes)
        s += fmt::format("set grid linecolor rgb {} linetype 1 linewidth 0.7\n", quoted(house::grid));
    else
        s += "unset border\nunset tics\nset margins 0,0,0,0\n";
    if (!p.title.empty()) s += fmt::format("set title {} textcolor rgb {}\n", quoted(p.title), quoted(house::ink));
    if (!p.x_label.empty()) s += fmt::format("set xlabel {} textcolor rgb {}\n", quoted(p.x_label), quoted(house::ink));
    if (!p.y_label.empty()) s += fmt::format("set ylabel {} textcolor rgb {}\n", quoted(p.y_label), quoted(house::ink));
    if (!p.x_ticks.empty()) {
        s += "set xtics (";
        for (std::size_t i = 0; i < p.x_ticks.size(); ++i)
            s += fmt::format("{}'{:g}' {:.10g}", i ? ", " : "", p.x_ticks[i], p.x_ticks[i]);
        s += ")\n";
    }
    if (p.log_x) s += "set logscale x\n";
    if (p.log_y) s += "set logscale y\n";
    if (p.equal_units) s += "set size ratio -1\n";
    if (p.legend.empty())
        s += "unset key\n";
    else if (p.legend == "outside")
        s += "set key outside right top noenhanced samplen 2\nset key enhanced\n";
    else
        s += fmt::format("set key {} samplen 2 spacing 1.2 opaque\n", p.legend);
    for (const Arrow& a : p.arrows)
        s += fmt::format(
            "set arrow from {:.10g},{:.10g} to {:.10g},{:.10g} {} filled front linecolor rgb {} linewidth {}\n",
            a.from.x, a.from.y, a.to.x, a.to.y, a.both_ends ? "heads" : "head", quoted(a.color), a.width);
    for (const Label& l : p.labels)
        s += fmt::format("set label {} at {:.10g},{:.10g} {} front textcolor rgb {} font {}\n", quoted(l.text), l.at.x,
                         l.at.y, word_of(l.align), quoted(l.color), quoted(fmt::format(",{}", l.size)));
    std::vector<std::string> parts;
    if (p.field) {
        s += script_of(*p.field);
        parts.push_back("$field using 1:2:3 with image notitle");
        if (!p.field->contours.empty())
            parts.push_back(fmt::format("$contours using 1:2 with lines linecolor rgb {} linewidth 2 notitle",
                                        quoted(p.field->contour_color)));
    }
    // After the table of contours, which must not be clipped by the ranges.
    if (p.x_range) s += fmt::format("set xrange [{:.10g}:{:.10g}]\n", p.x_range->x, p.x_range->y);
    if (p.y_range) s += fmt::format("set yrange [{:.10g}:{:.10g}]\n", p.y_range->x, p.y_range->y);
    for (std::size_t i = 0; i < p.curves.size(); ++i) {
        s += fmt::format("$c{} << EOD\n{}EOD\n", i, data_of(p.curves[i], p));
        parts.push_back(fmt::format("$c{} using 1:2 {} {}", i, style_of(p.curves[i]),
                                    p.curves[i].title.empty() ? "notitle" : "title " + quoted(p.curves[i].title)));
    }
    s += "plot ";
    for (std::size_t i = 0; i < parts.size(); ++i) s += (i ? ", \\\n     " : "") + parts[i];
    return s + "\n";
}

PlotImages draw(const Plot& p) {
    const std::string script = gnuplot_script(p);
    const std::string font = fmt::format("{},{}", house::font, house::font_size);
    PlotImages images;
    images.svg = run_gnuplot(
        fmt::format("set terminal svg size {},{} enhanced font '{}' background rgb 'white'\n", p.width, p.height, font),
        script);
    images.png = run_gnuplot(
        fmt::format("set terminal pngcairo size {},{} enhanced font '{}' fontscale 2 linewidth 2 pointscale 2 "
                    "background rgb 'white'\n",
                    2 * p.width, 2 * p.height, font),
        script);
    return images;
}

}  // namespace deburr
