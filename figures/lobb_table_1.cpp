// Lobb, table 1: what rounding costs.
#include <tbb/parallel_for.h>

#include <array>

#include "figures/figure.hpp"
#include "raytracer/render/integrator.hpp"
#include "raytracer/render/render_tiles.hpp"
#include "raytracer/trace/implicit_tracer.hpp"
#include "raytracer/util/cpu_time.hpp"

namespace deburr {
namespace {

// Traces one ray through each pixel's center, as in the paper.
void trace(const Scene& scene, const RayTracer& tracer) {
    const Integrator integrator(scene, tracer, {scene.width, scene.height, 1, 0});
    const Window window{0, 0, scene.width, scene.height};
    tbb::parallel_for(std::int64_t(0), tile_count(window), [&](std::int64_t i) {
        TraceCounters counters;
        std::array<Pixel, tile_side * tile_side> pixels;
        integrator.block(tile(window, i), pixels.data(), nullptr, counters);
    });
}

void make(FigureContext& context) {
    struct Row {
        const char *scene, *parameter, *figure;
        double paper;  // the paper's minutes with rounding over those without
    };
    const std::vector<Row> rows = {{"csg_examples.lua", "r", "12, CSG examples", 55.0 / 45},
                                   {"variable_rounding.lua", "softness", "13, variable rounding", 105.0 / 20},
                                   {"staplers.lua", "softness", "14, staplers", 240.0 / 70}};
    FigureTable table{{"figure", "rounded, s", "unrounded, s", "ratio", "the paper's"}, {}};
    std::vector<double> ratios;
    for (const Row& row : rows) {
        const Scene rounded = context.scene(row.scene), sharp = context.scene(row.scene, {{row.parameter, "0"}});
        const ImplicitTracer a(rounded.solids), b(sharp.solids);
        const Ratio ratio = ratio_of([&] { trace(rounded, a); }, [&] { trace(sharp, b); }, 5);
        ratios.push_back(ratio.value());
        table.rows.push_back({row.figure, fmt::format("{:.2f}", ratio.a), fmt::format("{:.2f}", ratio.b),
                              fmt::format("{:.2f}", ratio.value()), fmt::format("{:.1f}", row.paper)});
    }
    context.table(table);
    const auto [least, most] = std::minmax_element(ratios.begin(), ratios.end());
    context.measured(fmt::format("Rounding costs {:.2f} to {:.2f} times the unrounded scene.", *least, *most));
}

const RegisteredFigure registered{{
    .name = "lobb-table-1",
    .title = "Table 1: rendering times with and without rounding",
    .shows = "600 × 380 pixels, one sample each; CPU seconds of tracing, medians of five, measured in turns. Printed "
             "as figures 10 to 12, the "
             "scenes are those of figures 12 to 14.",
    .claim = "The rounded images cost from 1.5 to 5 times as much as the unrounded ones (§4.3; the table's own ratios "
             "are 1.2, 5.3 and 3.4).",
    .scenes = {"csg_examples.lua", "variable_rounding.lua", "staplers.lua"},
    .seconds = 15,
    .make = make,
}};

}  // namespace
}  // namespace deburr
