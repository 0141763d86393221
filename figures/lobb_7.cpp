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

void make(FigureContext& context) {
    // A block with a slot and a wedge beside it: a legal difference and a legal sum.
    const Density wedge = Density::half_space({0.35, 1, 0}, 0.35 * 5.1 + 1.75) * block(4.6, 0, 6.1, 4);
    const DensityTree tree = flatten(block(0, 0, 3.6, 2.3) - block(1.2, 0.8, 2.2, 2.3) + wedge, r);
    const LocalDensity density(tree);
    const BoundCsg outer = outer_bound(tree, 0.5), inner = inner_bound(tree, 0.5);
    const BoundCsg by_r = outer_bound(tree, 0), by_minus_r = inner_bound(tree, 1);

    const Vec2 start{-1.2, 1.22}, end{7.3, 1.52}, direction = glm::normalize(end - start);
    const double length = glm::length(end - start);
    SearchSpans search;
    const auto spans = [&](const BoundCsg& o, const BoundCsg& i) {
        return search.between(o, i, in_space(start), in_space(direction), 0, length);
    };
    const BoundCsg nothing{{}, {{BoundCsg::Kind::nothing}}, false};
    const std::vector<Span> in_outer = spans(outer, nothing), in_inner = spans(inner, nothing),
                            regions = spans(outer, inner), wide = spans(by_r, by_minus_r);
    RayDensity ray;
    ray.set(density, in_space(start), in_space(direction));
    RootCounters counters;
    RootFinder finder({}, counters);
    std::vector<double> roots;
    finder.crossings(ray, 0, length, [&](RootCrossing c) {
        roots.push_back(c.t);
        return true;
    });

    Plot plot = drawing(900, 520);
    plot.x_range = Vec2(-3.3, 7.6);
    plot.y_range = Vec2(-3.2, 2.85);
    const Vec2 lo{-1, -0.9}, hi{7.2, 3.2};
    const auto fill = [&](const std::function<double(Vec2)>& f, const char* color, double outline) {
        for (const auto& line : level_lines(f, 0.5, lo, hi, 246, 123))
            plot.curves.push_back({.points = line, .color = color, .kind = Curve::Kind::fill, .width = outline});
    };
    fill([&](Vec2 x) { return outer.contains(in_space(x)) ? 1 : 0; }, house::shade, 0);
    fill([&](Vec2 x) { return inner.contains(in_space(x)) ? 1 : 0; }, "#b3c8de", 0);
    for (const auto& line : level_lines([&](Vec2 x) { return density.at(in_space(x)); }, 0.5, lo, hi, 246, 123))
        plot.curves.push_back({.points = line, .color = house::blue, .width = 2.4});
    const auto at = [&](double t) { return start + t * direction; };
    for (const Span& s : regions)
        plot.curves.push_back({.points = {at(s.lo), at(s.hi)}, .color = house::amber, .width = 6});
    plot.arrows.push_back({.from = start, .to = end, .color = house::ink, .width = 1.6});

    // Draws the ray's state, from outside (low) to inside (high).
    const auto state = [&](double base, const std::vector<Span>& inside, const std::string& name, const char* color) {
        std::vector<Vec2> points{{at(0).x, base}};
        for (const Span& s : inside)
            for (const Vec2 p : {Vec2(s.lo, 0), Vec2(s.lo, 1), Vec2(s.hi, 1), Vec2(s.hi, 0)})
                points.push_back({at(p.x).x, base + 0.42 * p.y});
        points.push_back({at(length).x, base});
        plot.curves.push_back({.points = points, .color = color, .width = 2});
        plot.labels.push_back({.at = {-1.45, base + 0.2}, .text = name, .align = Label::Align::right});
    };
    const double a = -1.4, b = -2.2, c = -3.0;
    for (const Span& s : regions) {
        const double x0 = at(s.lo).x, x1 = at(s.hi).x;
        plot.curves.push_back({.points = {{x0, c}, {x1, c}, {x1, c + 0.42}, {x0, c + 0.42}, {x0, c}},
                               .color = house::amber,
                               .kind = Curve::Kind::fill,
                               .width = 0,
                               .opacity = 0.7});
    }
    state(a, in_outer, "(a) expanded", house::blue);
    state(b, in_inner, "(b) contracted", house::blue);
    plot.curves.push_back({.points = {{at(0).x, c}, {at(length).x, c}}, .color = house::ink, .width = 1.2});
    plot.labels.push_back({.at = {-1.45, c + 0.2}, .text = "(c) search", .align = Label::Align::right});
    int held = 0;
    for (const double t : roots) {
        const Vec2 x = at(t);
        plot.curves.push_back({.points = {{x.x, x.y}, {x.x, c}}, .color = house::grey, .width = 0.8, .dash = "."});
        plot.curves.push_back({.points = circle(x, 0.06), .color = house::red, .kind = Curve::Kind::fill, .width = 0});
        for (const Span& s : regions) held += s.lo <= t && t <= s.hi;
    }
    context.plot(plot);
    context.measured(fmt::format(
        "The ray crosses the surface {} times, {} of them in the {} stretches that are searched. These are {:.1f} % of "
        "the ray; planes "
        "moved by r and −r, which would do (§3.2), leave {:.1f} %.",
        roots.size(), held, regions.size(), 100 * length_of(regions) / length, 100 * length_of(wide) / length));
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
