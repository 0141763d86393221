// Counts the work that a picture takes.
#include <fmt/format.h>

#include "bench/picture.hpp"
#include "bench/sections.hpp"
#include "raytracer/trace/implicit_tracer.hpp"

namespace deburr::bench {

void work_per_pixel(Report& report) {
    for (const char* name : {"csg_examples", "variable_rounding"}) {
        const Scene scene = scene_of(name);
        const ImplicitTracer tracer(scene.solids);
        TraceCounters counters;
        render_picture(scene, tracer, counters);
        const double pixels = double(scene.width) * scene.height;
        const auto per_pixel = [&](const char* what, std::uint64_t count) {
            report.figure(fmt::format("{}: {}", name, what), double(count) / pixels, "a pixel");
        };
        per_pixel("rays and shadow rays", counters.rays + counters.shadow_rays);
        per_pixel("cells", counters.cells);
        per_pixel("evaluations of a density", counters.evaluations);
        per_pixel("splits", counters.splits);
        per_pixel("hits of flat faces", counters.flat_hits);
    }
}

}  // namespace deburr::bench
