// One thread against two: wall-clock time, the only figure here that other programs distort, and the CPU time that the
// second thread adds.
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <chrono>

#include "bench/picture.hpp"
#include "bench/sections.hpp"
#include "raytracer/render/render_tiles.hpp"
#include "raytracer/trace/implicit_tracer.hpp"

namespace deburr::bench {
namespace {

template <class Work>
double wall_seconds_of(Work&& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

void one_thread_and_two(Report& report) {
    const std::atomic<bool> stop{false};
    for (const char* name : {"csg_examples", "variable_rounding"}) {
        const Scene scene = scene_of(name);
        const ImplicitTracer tracer(scene.solids);
        const Integrator integrator(scene, tracer, {scene.width, scene.height, 1, 0});
        const auto trace = [&](std::size_t threads) {
            const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
            keep(render(
                     Film(scene.width, scene.height, {0, 0, scene.width, scene.height}),
                     [&](const Window& block, Pixel* pixels, PixelLayers* layers, TraceCounters& counters) {
                         integrator.block(block, pixels, layers, counters);
                     },
                     stop)
                     .pixels_done);
        };
        report.ratio(fmt::format("{}: one thread / two, on the wall", name),
                     ratio_of_times([&] { return wall_seconds_of([&] { trace(1); }); },
                                    [&] { return wall_seconds_of([&] { trace(2); }); }, 9));
        report.ratio(fmt::format("{}: two threads / one, CPU time", name),
                     ratio_of([&] { trace(2); }, [&] { trace(1); }, 9));
    }
}

}  // namespace deburr::bench
