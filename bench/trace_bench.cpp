// What exact tracing costs: rounded against sharp [Lobb table 1], many blocks against few, the exact
// criterion against the printed one.
#include <benchmark/benchmark.h>

#include "bench/ratio.hpp"
#include "raytracer/bsp.hpp"
#include "raytracer/integrator.hpp"
#include "raytracer/scene_reader.hpp"

using namespace deburr;

namespace {

// A picture of the scene, one sample a pixel, on one thread.
void render(const Scene& scene, const RayTracer& tracer, TraceCounters& counters) {
    const Integrator integrator(scene, tracer, {scene.width, scene.height, 1, 0});
    for (int y = 0; y < scene.height; ++y)
        for (int x = 0; x < scene.width; ++x) benchmark::DoNotOptimize(integrator.pixel(x, y, counters));
}

// Lobb's table 1: the same picture with every radius 0. There it is 1.2 to 5.3 times.
void rounded_against_sharp(benchmark::State& state, const char* file) {
    const std::string path = std::string(DEBURR_SOURCE_DIR "/scenes/") + file;
    const Scene rounded = read_scene(path, {}), sharp = read_scene(path, {{"r", "0"}});
    const ImplicitTracer of_rounded(rounded.solids), of_sharp(sharp.solids);
    TraceCounters counters;
    for (auto _ : state) {
        const Ratio ratio = ratio_of([&] { render(rounded, of_rounded, counters); },
                                     [&] { render(sharp, of_sharp, counters); });
        state.counters["rounded_s"] = ratio.a;
        state.counters["sharp_s"] = ratio.b;
        state.counters["ratio"] = ratio.value();
    }
}
BENCHMARK_CAPTURE(rounded_against_sharp, csg_examples, "csg_examples.lua")->Iterations(1)->Unit(benchmark::kSecond);

// Tilted rounded blocks on a cubic grid, seen from all sides.
std::vector<Solid> blocks(int count) {
    const int side = std::max(1, int(std::lround(std::cbrt(count))));
    std::vector<Solid> solids;
    for (int i = 0; i < count; ++i) {
        const double a = 0.7 * i, c = std::cos(a), s = std::sin(a);
        const Affine place{Mat3(0.6 * c, 0.6 * s, 0, -0.6 * s, 0.6 * c, 0, 0, 0, 0.6),
                           Vec3(i % side, i / side % side, i / side / side)};
        solids.push_back(Solid::rounded(0.08, Density::box(Vec3(-0.5), Vec3(0.5))).transformed(place));
    }
    return solids;
}

void rays_through_blocks(benchmark::State& state) {
    const int count = int(state.range(0));
    const ImplicitTracer tracer(blocks(count));
    const double side = std::max(1.0, std::round(std::cbrt(count)));
    TraceCounters counters;
    std::uint32_t n = 0;
    const auto fraction = [](double x) { return x - std::floor(x); };
    for (auto _ : state) {
        ++n;  // points of two Kronecker sequences: everywhere, and the same in every run
        const Vec3 target = side * Vec3(fraction(0.8192 * n), fraction(0.6711 * n), fraction(0.5497 * n));
        const double phi = 6.2831853 * fraction(0.6180 * n), z = 2 * fraction(0.7549 * n) - 1;
        const Vec3 eye = Vec3(0.5 * side) + 2 * side * Vec3(std::cos(phi) * std::sqrt(1 - z * z), z,
                                                            std::sin(phi) * std::sqrt(1 - z * z));
        benchmark::DoNotOptimize(tracer.first_hit({eye, glm::normalize(target - eye)}, infinity, counters));
    }
    state.counters["cells_per_ray"] = double(counters.cells) / double(counters.rays);
    state.counters["evaluations_per_ray"] = double(counters.evaluations) / double(counters.rays);
}
BENCHMARK(rays_through_blocks)->Arg(10)->Arg(100)->Arg(1000)->Arg(10000)->MinWarmUpTime(0.2)->Repetitions(5)->ReportAggregatesOnly();

void build_of_blocks(benchmark::State& state) {
    const std::vector<Solid> solids = blocks(int(state.range(0)));
    for (auto _ : state) benchmark::DoNotOptimize(ImplicitTracer(solids).statistics().cells);
}
BENCHMARK(build_of_blocks)->Arg(100)->Arg(1000)->Arg(10000)->Unit(benchmark::kMillisecond);

void exact_against_printed_criterion(benchmark::State& state) {
    const Scene scene = read_scene(DEBURR_SOURCE_DIR "/scenes/variable_rounding.lua", {});
    const ImplicitTracer exact(scene.solids), printed(scene.solids, Criterion::lobb);
    TraceCounters of_exact, of_printed;
    for (auto _ : state) {
        const Ratio ratio = ratio_of([&] { render(scene, exact, of_exact); },
                                     [&] { render(scene, printed, of_printed); });
        state.counters["ratio"] = ratio.value();
        state.counters["segments_ratio"] = double(of_exact.segments) / double(of_printed.segments);
    }
}
BENCHMARK(exact_against_printed_criterion)->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace
