// Triage §6.2 and §6.3: time, polygons and distance against marching cubes; growth with the number of half-spaces.
#include "figures/figure.hpp"
#include "figures/plot.hpp"
#include "polygonizer/marching_cubes/marching_cubes.hpp"
#include "polygonizer/mesh/metrics.hpp"
#include "polygonizer/triage/triage.hpp"
#include "raytracer/util/cpu_time.hpp"

namespace deburr {
namespace {

// A factor: a whole number from 10 on, with one decimal below.
std::string times(double x) { return x >= 10 ? fmt::format("{:.0f}", x) : fmt::format("{:.1f}", x); }

void against_marching_cubes(FigureContext& context) {
    FigureTable table{{"r", "Triage, triangles", "ms", "largest distance / r", "marching cubes, triangles", "ms",
                       "largest distance / r", "share of triangles", "times as fast", "at the same distance"},
                      {}};
    Plot plot;
    plot.x_label = "rounding radius (the cube's side is 1)";
    plot.y_label = "CPU time of marching cubes / of Triage";
    plot.log_x = plot.log_y = true;
    plot.legend = "top right";
    plot.x_range = Vec2(0.015, 0.32);
    plot.x_ticks = {0.02, 0.05, 0.1, 0.15, 0.2, 0.25};
    Curve as_is{.points = {}, .title = "as in the paper", .kind = Curve::Kind::points_and_line};
    Curve equal{.points = {},
                .title = "Triage refined to the same largest distance",
                .color = house::red,
                .kind = Curve::Kind::points_and_line};
    double cross = infinity;
    for (const double r : {0.02, 0.035, 0.05, 0.1, 0.15, 0.2, 0.25}) {
        const Scene scene = context.scene("csg_examples.lua", {{"r", fmt::format("{}", r)}});
        const SolidTree tree = flatten(scene.solids.at(4));
        const Box box = polygonization_box(tree);
        Mesh plain, cubes, fine;
        const Ratio ratio =
            ratio_of([&] { cubes = marching_cubes(tree, box, r / 2); }, [&] { plain = triage(tree, box); }, 3);
        const MeshMetrics of_plain = measure(plain, tree), of_cubes = measure(cubes, tree);
        const double finer = median([&] {
            std::vector<double> times;
            for (int k = 0; k < 3; ++k)
                times.push_back(
                    cpu_seconds_of([&] { fine = triage(tree, box, {.tolerance = of_cubes.distance.max}); }));
            return times;
        }());
        table.rows.push_back(
            {fmt::format("{:g}", r), fmt::format("{}", plain.triangles.size()), fmt::format("{:.1f}", 1e3 * ratio.b),
             fmt::format("{:.3f}", of_plain.distance.max / r), fmt::format("{}", cubes.triangles.size()),
             fmt::format("{:.1f}", 1e3 * ratio.a), fmt::format("{:.3f}", of_cubes.distance.max / r),
             fmt::format("{:.1f} %", 100.0 * double(plain.triangles.size()) / double(cubes.triangles.size())),
             times(ratio.value()), times(ratio.a / finer)});
        as_is.points.push_back({r, ratio.value()});
        equal.points.push_back({r, ratio.a / finer});
        if (ratio.value() < 1) cross = std::min(cross, r);
    }
    plot.curves = {
        {.points = {{0.015, 20}, {0.32, 20}}, .title = "the paper's 20 to 30", .color = house::grey, .dash = "-"},
        {.points = {{0.015, 30}, {0.32, 30}}, .color = house::grey, .dash = "-"},
        {.points = {{0.015, 1}, {0.32, 1}}, .color = house::ink, .width = 1},
        as_is,
        equal};
    context.table(table);
    context.plot(plot);
    context.measured(fmt::format("{} times as fast at r = {:g}, {} times at {:g}. {}", table.rows.front()[8],
                                 as_is.points.front().x, table.rows.back()[8], as_is.points.back().x,
                                 cross < infinity
                                     ? fmt::format("Marching cubes wins from r = {:g} on.", cross)
                                     : std::string("Marching cubes does not win up to a quarter of the object.")));
}

// Rounded boxes of six half-spaces each on a cubic grid, as one Boolean density.
SolidTree boxes(int count) {
    const int side = int(std::ceil(std::cbrt(count) - 1e-9));
    const auto box = [&](int k) {
        const Vec3 lo(2.0 * (k % side), 2.0 * (k / side % side), 2.0 * (k / side / side));
        return Density::box(lo, lo + Vec3(1.0));
    };
    Density all = box(0);
    for (int k = 1; k < count; ++k) all = all | box(k);
    return flatten(Solid::rounded(0.05, all));
}

void growth(FigureContext& context) {
    FigureTable table{{"half-spaces n", "triangles", "ms", "µs per half-space"}, {}};
    Curve measured{.points = {}, .title = "measured", .kind = Curve::Kind::points};
    for (const int count : {1, 4, 16, 64, 256, 1024}) {
        const SolidTree tree = boxes(count);
        const Box box = polygonization_box(tree);
        std::size_t triangles = 0;
        std::vector<double> times;
        const int rounds = count < 200 ? 7 : 3;
        for (int k = 0; k < rounds; ++k)
            times.push_back(cpu_seconds_of([&] { triangles = triage(tree, box).triangles.size(); }));
        const double n = 6.0 * count, seconds = median(times);
        measured.points.push_back({n, 1e3 * seconds});
        table.rows.push_back({fmt::format("{:g}", n), fmt::format("{}", triangles),
                              fmt::format("{:.2f}", 1e3 * seconds), fmt::format("{:.0f}", 1e6 * seconds / n)});
    }
    // Least squares for log t = log c + p log n.
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    const double m = double(measured.points.size());
    for (const Vec2& p : measured.points) {
        const double x = std::log(p.x), y = std::log(p.y);
        sx += x, sy += y, sxx += x * x, sxy += x * y;
    }
    const double power = (m * sxy - sx * sy) / (m * sxx - sx * sx), factor = std::exp((sy - power * sx) / m);
    const Vec2 first = measured.points.front(), last = measured.points.back();
    Plot plot;
    plot.x_label = "half-spaces {/:Italic n}";
    plot.y_label = "CPU time, ms";
    plot.log_x = plot.log_y = true;
    plot.legend = "top left";
    plot.curves = {
        {.points = {first, {last.x, first.y * std::pow(last.x / first.x, 1.3)}},
         .title = "{/:Italic n}^{1.3}, the paper's",
         .color = house::grey,
         .dash = "-"},
        {.points = {{first.x, factor * std::pow(first.x, power)}, {last.x, factor * std::pow(last.x, power)}},
         .title = fmt::format("fitted: {{/:Italic n}}^{{{:.2f}}}", power),
         .color = house::red},
        measured};
    context.plot(plot);
    context.table(table);
    context.measured(fmt::format("Fitted exponent {:.2f} over {:g} to {:g} half-spaces.", power, first.x, last.x));
}

const RegisteredFigure compared{{
    .name = "triage-table-6.2",
    .title = "§6.2: Triage against marching cubes",
    .shows = "Lobb's obj4, the cube with a rounded pit, with marching cubes at half the radius. Distances are the "
             "largest at the triangles' "
             "middles, by root search. The last column is for Triage refined by --tolerance until it is as near as "
             "marching cubes.",
    .claim = "20 to 30 times faster and 1 to 2 % of the polygons on average; marching cubes becomes superior at about "
             "a quarter of the "
             "object's size.",
    .scenes = {"csg_examples.lua"},
    .plots = true,
    .seconds = 25,
    .make = against_marching_cubes,
}};

const RegisteredFigure grown{{
    .name = "triage-table-6.3",
    .title = "§6.3: growth with the number of half-spaces",
    .shows = "One rounded density of 1 to 1024 boxes.",
    .claim = "An average time complexity of about O(n^1.3), which a better BSP construction would make O(n log n).",
    .plots = true,
    .seconds = 15,
    .make = growth,
}};

}  // namespace
}  // namespace deburr
