// Lobb, figure 7: a ray through the expanded and the contracted object.
#include "bounds/csg_bounds.hpp"
#include "bounds/root_finder.hpp"
#include "figures/figure.hpp"
#include "figures/plane_curves.hpp"

namespace deburr {
namespace {

constexpr double r = 0.34;

// A block, infinite along z, in which direction the picture is seen.
Density block(double x0, double y0, double x1, double y1) {
    return Density::product({Density::half_space({-1, 0, 0}, -x0), Density::half_space({1, 0, 0}, x1),
                             Density::half_space({0, -1, 0}, -y0), Density::half_space({0, 1, 0}, y1)});
}

Vec3 in_space(Vec2 x) { return {x, 0}; }

double length_of(const std::vector<Span>& spans) {
    double sum = 0;
    for (const Span& s : spans) sum += s.hi - s.lo;
    return sum;
}

// The ray.
const Vec2 start{-1.2, 1.22}, end{7.3, 1.52}, direction = glm::normalize(end - start);
const double length = glm::length(end - start);

Vec2 at(double t) { return start + t * direction; }

// A block with a slot and a wedge beside it: a legal difference and a legal sum.
DensityTree block_and_wedge() {
    const Density wedge = Density::half_space({0.35, 1, 0}, 0.35 * 5.1 + 1.75) * block(4.6, 0, 6.1, 4);
    return flatten(block(0, 0, 3.6, 2.3) - block(1.2, 0.8, 2.2, 2.3) + wedge, r);
}

// The ray's spans inside the outer bound and outside of the inner one.
std::vector<Span> spans_between(const BoundCsg& outer, const BoundCsg& inner) {
    SearchSpans search;
    return search.between(outer, inner, in_space(start), in_space(direction), 0, length);
}

std::vector<Span> spans_inside(const BoundCsg& bound) {
    return spans_between(bound, {{}, {{BoundCsg::Kind::nothing}}, false});
}

// The distances along the ray at which it crosses the isosurface.
std::vector<double> crossings_of(const LocalDensity& density) {
    RayDensity ray;
    ray.set(density, in_space(start), in_space(direction));
    RootCounters counters;
    RootFinder finder({}, counters);
    std::vector<double> roots;
    finder.crossings(ray, 0, length, [&](RootCrossing c) {
        roots.push_back(c.t);
        return true;
    });
    return roots;
}

// The lines f = ½ in the part of the plane that holds the objects.
std::vector<std::vector<Vec2>> borders(const std::function<double(Vec2)>& f) {
    return level_lines(f, 0.5, {-1, -0.9}, {7.2, 3.2}, 246, 123);
}

void add_object(Plot& plot, const BoundCsg& object, const char* color) {
    for (const auto& line : borders([&](Vec2 x) { return object.contains(in_space(x)) ? 1 : 0; }))
        plot.curves.push_back({.points = line, .color = color, .kind = Curve::Kind::fill, .width = 0});
}

void add_isosurface(Plot& plot, const LocalDensity& density) {
    for (const auto& line : borders([&](Vec2 x) { return density.at(in_space(x)); }))
        plot.curves.push_back({.points = line, .color = house::blue, .width = 2.4});
}

void add_ray(Plot& plot, const std::vector<Span>& searched) {
    for (const Span& s : searched)
        plot.curves.push_back({.points = {at(s.lo), at(s.hi)}, .color = house::amber, .width = 6});
    plot.arrows.push_back({.from = start, .to = end, .color = house::ink, .width = 1.6});
}

// Heights of the diagrams below the ray, and the height of a state in them.
constexpr double base_a = -1.4, base_b = -2.2, base_c = -3.0, state_height = 0.42;

void add_name(Plot& plot, double base, const char* name) {
    plot.labels.push_back({.at = {-1.45, base + 0.2}, .text = name, .align = Label::Align::right});
}

// Adds a diagram of the ray's state, from outside (low) to inside (high).
void add_state(Plot& plot, double base, const std::vector<Span>& inside, const char* name) {
    std::vector<Vec2> points{{at(0).x, base}};
    for (const Span& s : inside)
        for (const Vec2 p : {Vec2(s.lo, 0), Vec2(s.lo, 1), Vec2(s.hi, 1), Vec2(s.hi, 0)})
            points.push_back({at(p.x).x, base + state_height * p.y});
    points.push_back({at(length).x, base});
    plot.curves.push_back({.points = points, .color = house::blue, .width = 2});
    add_name(plot, base, name);
}

// Adds bars over the stretches that are searched.
void add_searched(Plot& plot, const std::vector<Span>& searched) {
    const double c = base_c, top = c + state_height;
    for (const Span& s : searched) {
        const double x0 = at(s.lo).x, x1 = at(s.hi).x;
        plot.curves.push_back({.points = {{x0, c}, {x1, c}, {x1, top}, {x0, top}, {x0, c}},
                               .color = house::amber,
                               .kind = Curve::Kind::fill,
                               .width = 0,
                               .opacity = 0.7});
    }
}

// Adds the line below the bars.
void add_search_axis(Plot& plot) {
    plot.curves.push_back({.points = {{at(0).x, base_c}, {at(length).x, base_c}}, .color = house::ink, .width = 1.2});
    add_name(plot, base_c, "(c) search");
}

// Adds the crossing, and a dotted line from it to the stretches that are searched.
void add_crossing(Plot& plot, double t) {
    const Vec2 x = at(t);
    plot.curves.push_back({.points = {{x.x, x.y}, {x.x, base_c}}, .color = house::grey, .width = 0.8, .dash = "."});
    plot.curves.push_back({.points = circle(x, 0.06), .color = house::red, .kind = Curve::Kind::fill, .width = 0});
}

void make(FigureContext& context) {
    const DensityTree tree = block_and_wedge();
    const LocalDensity density(tree);
    const BoundCsg outer = outer_bound(tree, 0.5), inner = inner_bound(tree, 0.5);
    const std::vector<Span> searched = spans_between(outer, inner),
                            moved_by_r = spans_between(outer_bound(tree, 0), inner_bound(tree, 1));
    const std::vector<double> crossings = crossings_of(density);

    Plot plot = drawing(900, 520);
    plot.x_range = Vec2(-3.3, 7.6);
    plot.y_range = Vec2(-3.2, 2.85);
    add_object(plot, outer, house::shade);
    add_object(plot, inner, "#b3c8de");
    add_isosurface(plot, density);
    add_ray(plot, searched);
    add_searched(plot, searched);
    add_state(plot, base_a, spans_inside(outer), "(a) expanded");
    add_state(plot, base_b, spans_inside(inner), "(b) contracted");
    add_search_axis(plot);
    int held = 0;
    for (const double t : crossings) {
        add_crossing(plot, t);
        for (const Span& s : searched) held += s.lo <= t && t <= s.hi;
    }
    context.plot(plot);
    context.measured(fmt::format(
        "The ray crosses the surface {} times, {} of them in the {} stretches that are searched. These are {:.1f} % of "
        "the ray; planes moved by r and −r, which would do (§3.2), leave {:.1f} %.",
        crossings.size(), held, searched.size(), 100 * length_of(searched) / length,
        100 * length_of(moved_by_r) / length));
}

const RegisteredFigure registered{{
    .name = "lobb-7",
    .title = "Figure 7: regions where a ray may cross the 0.5 isosurface",
    .shows = "Pale the expanded object, darker the contracted one, blue the isosurface; below, where the ray is inside "
             "the one (a) and the "
             "other (b), and in amber (c) the stretches in which roots (red) are searched.",
    .claim = "Isosurface crossings are confined to where the ray is inside the expanded and outside the contracted "
             "object; expansion by r and "
             "−r would do, but much tighter bounds are possible (§3.2).",
    .plots = true,
    .seconds = 2,
    .make = make,
}};

}  // namespace
}  // namespace deburr
