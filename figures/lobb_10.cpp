// Lobb, figure 10: how long a segment must be to hold several roots; the printed criterion and the exact one.
#include "bounds/root_finder.hpp"
#include "figures/figure.hpp"
#include "figures/plot.hpp"

namespace deburr {
namespace {

// A stretch of a motion with constant f″ = push, of duration `time`.
struct Piece {
    double push, time;
};

struct Motion {
    std::vector<Vec2> points = {};
    double t = 0, f = 0, slope = 0;

    void follow(const std::vector<Piece>& pieces) {
        points.push_back({t, f});
        for (const auto& [push, time] : pieces) {
            constexpr int steps = 80;
            for (int k = 1; k <= steps; ++k) {
                const double dt = time * k / steps;
                points.push_back({t + dt, f + slope * dt + 0.5 * push * dt * dt});
            }
            f += slope * time + 0.5 * push * time * time;
            slope += push * time;
            t += time;
        }
    }
};

// The fastest motion to f = 0 with f′ = 0 under |f″| ≤ G [root_finder.cpp].
Motion quickest(double f, double slope, double G) {
    const double w = std::sqrt(G * f + 0.5 * slope * slope);
    Motion m{.f = f, .slope = slope};
    m.follow({{-G, (slope + w) / G}, {G, w / G}});
    return m;
}

Plot panel(const std::string& title, Vec2 x_range, Vec2 y_range) {
    Plot plot;
    plot.width = 420;
    plot.height = 340;
    plot.title = title;
    plot.x_label = "distance along the ray";
    plot.y_label = "ρ − ½";
    plot.x_range = x_range;
    plot.y_range = y_range;
    plot.legend = "";
    plot.curves.push_back({.points = {{x_range.x, 0}, {x_range.y, 0}}, .color = house::ink, .width = 1});
    return plot;
}

void dot(Plot& plot, Vec2 at, const char* color) {
    plot.curves.push_back({.points = {at}, .color = color, .kind = Curve::Kind::points, .width = 2});
}

void upright(Plot& plot, double x, Vec2 range, const std::string& text, const char* color, double y,
             Label::Align align) {
    plot.curves.push_back({.points = {{x, range.x}, {x, range.y}}, .color = color, .width = 1.3, .dash = "-"});
    plot.labels.push_back(
        {.at = {x + (align == Label::Align::right ? -0.06 : 0.06), y}, .text = text, .align = align, .color = color});
}

const RayBounds bounds{1, 1, 1};

// Least distances from a segment's end to a turning point beyond a root.
struct TurningDistances {
    double printed, exact;
};

TurningDistances turning_distances(SegmentEnd end) {
    return {lobb_turning_distance(end, bounds), min_turning_distance(end, bounds)};
}

// Adds dots at the motion's ends.
void add_ends(Plot& plot, const Motion& motion) {
    dot(plot, motion.points.front(), house::blue);
    dot(plot, {motion.t, motion.f}, house::blue);
}

// The slope points towards the root.
void towards_root(FigureContext& context) {
    const SegmentEnd end{0.45, -0.5};
    const auto [printed, exact] = turning_distances(end);
    const Vec2 y{-0.15, 0.6};
    Plot plot = panel("(a) towards the root", {0, 2.2}, y);
    const Motion m = quickest(end.f, end.slope, bounds.G);
    plot.curves.push_back({.points = m.points, .color = house::blue, .width = 2.6});
    plot.curves.push_back(
        {.points = {{0, end.f}, {end.f / bounds.L, 0}}, .color = house::grey, .width = 1.4, .dash = "."});
    add_ends(plot, m);
    upright(plot, printed, y, "eq. 6", house::red, 0.53, Label::Align::left);
    upright(plot, exact, y, "exact", house::green, 0.46, Label::Align::left);
    context.plot(plot, fmt::format("ρ₁ and ρ₁′ of different signs: at least {:.2f}, exactly {:.2f}", printed, exact));
}

// The way that eq. 6 assumes where the slope points away from the root: the density returns to its value with the
// opposite slope, at the distance `turn_around`, and then heads for the turning point.
Motion turned_around(SegmentEnd end, double turn_around) {
    Motion back{.f = end.f, .slope = end.slope};
    back.follow({{-bounds.G, turn_around}, {bounds.G, end.slope / bounds.G}});
    return back;
}

// The slope points away from the root: the turn-around.
void away_from_root(FigureContext& context) {
    const SegmentEnd end{0.12, 0.7};
    const auto [printed, exact] = turning_distances(end);
    const Vec2 y{-0.15, 0.6};
    Plot plot = panel("(b) away from the root", {0, 3}, y);
    const double turn_around = 2 * end.slope / bounds.G;
    const Motion m = quickest(end.f, end.slope, bounds.G);
    plot.curves.push_back(
        {.points = {{0, end.f}, {turn_around, end.f}}, .color = house::grey, .width = 1.2, .dash = "."});
    plot.labels.push_back({.at = {0.5 * turn_around, end.f - 0.035},
                           .text = "turn-around",
                           .align = Label::Align::center,
                           .color = house::grey});
    plot.curves.push_back({.points = m.points, .color = house::blue, .width = 2.6});
    plot.curves.push_back(
        {.points = turned_around(end, turn_around).points, .color = house::ink, .width = 1.4, .dash = "-"});
    add_ends(plot, m);
    upright(plot, printed, y, "eq. 6", house::red, 0.53, Label::Align::left);
    upright(plot, exact, y, "exact", house::green, 0.53, Label::Align::right);
    context.plot(plot, fmt::format("Of one sign: eq. 6 says {:.2f}, but braking early needs {:.2f}", printed, exact));
}

// A segment with two roots that eq. 6 accepts: its length, and both of its ends.
constexpr double length = 5.5;
constexpr SegmentEnd either_end{1e-12, 1};

// A motion along the segment, down to a lowest point in its middle, and back.
Motion down_and_back() {
    const double w = (length / 2 - 1) / 2;
    Motion m{.f = either_end.f, .slope = either_end.slope};
    m.follow({{-1, 1 + w}, {1, 2 * w}, {-1, 1 + w}});
    return m;
}

// Distances at which the motion's sign has changed.
std::vector<double> sign_changes(const Motion& m) {
    std::vector<double> changes;
    for (std::size_t k = 1; k < m.points.size(); ++k)
        if ((m.points[k].y > 0) != (m.points[k - 1].y > 0)) changes.push_back(m.points[k].x);
    return changes;
}

double lowest_value(const Motion& m) {
    double lowest = infinity;
    for (const Vec2 p : m.points) lowest = std::min(lowest, p.y);
    return lowest;
}

void segment_with_two_roots(FigureContext& context, const Motion& m) {
    const auto [printed, exact] = turning_distances(either_end);
    const Vec2 y{-0.45, 0.75};
    Plot plot = panel("(c) a segment with two roots", {0, 6.2}, y);
    plot.curves.push_back({.points = m.points, .color = house::blue, .width = 2.6});
    for (const double t : sign_changes(m)) dot(plot, {t, 0}, house::red);
    add_ends(plot, m);
    upright(plot, 2 * printed, y, "eq. 6", house::red, 0.6, Label::Align::right);
    upright(plot, 2 * exact, y, "exact", house::green, 0.6, Label::Align::right);
    context.plot(plot, fmt::format("Length {:g}: eq. 6 accepts up to {:.2f}, the exact criterion up to {:.2f}", length,
                                   2 * printed, 2 * exact));
}

void make(FigureContext& context) {
    context.columns(3);
    towards_root(context);
    away_from_root(context);
    const Motion m = down_and_back();
    segment_with_two_roots(context, m);
    const auto accepts = [](Criterion c) { return at_most_one_root(either_end, either_end, bounds, length, c); };
    context.measured(fmt::format(
        "With L = G = 1, f = 0⁺ and slope 1 inwards at both ends, a segment of length {:g} is {} by eq. 6 as holding "
        "at most one root, and the function drawn in (c), which keeps to the bounds, has {} (lowest value {:.3f}). The "
        "exact criterion {} it. Eq. 6 is not a safe bound; rendering uses the exact one.",
        length, accepts(Criterion::lobb) ? "accepted" : "refused", sign_changes(m).size(), lowest_value(m),
        accepts(Criterion::exact) ? "accepts" : "refuses"));
}

const RegisteredFigure registered{{
    .name = "lobb-10",
    .title = "Figure 10: ray segment length constraints for multiple roots",
    .shows = "Blue the quickest function within the bounds |f′| ≤ L, |f″| ≤ G from a segment's end to a turning point "
             "beyond a root; red what "
             "eq. 6 takes to be the least distance, green the exact one. Dashed in (b) the way that eq. 6 assumes: "
             "back to the start's density with the slope negated.",
    .claim = "A segment that holds several roots is at least as long as eq. 6 says, with the turn-around distance "
             "added where density and "
             "slope have the same sign (§3.4.2).",
    .plots = true,
    .seconds = 1,
    .make = make,
}};

}  // namespace
}  // namespace deburr
