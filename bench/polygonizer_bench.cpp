// What meshes cost: triage against half-spaces [Triage §6.3], and against marching cubes at half the
// radius [Triage §6.2].
#include <benchmark/benchmark.h>

#include "bench/ratio.hpp"
#include "polygonizer/marching_cubes.hpp"
#include "polygonizer/metrics.hpp"
#include "polygonizer/triage.hpp"

using namespace deburr;

namespace {

// Boxes on a cubic grid, six half-spaces each, as one Boolean density.
SolidTree boxes(int count) {
    const int side = int(std::ceil(std::cbrt(count) - 1e-9));
    std::vector<Density> row;
    for (int k = 0; k < count; ++k) {
        const Vec3 lo(2.0 * (k % side), 2.0 * (k / side % side), 2.0 * (k / side / side));
        row.push_back(Density::box(lo, lo + Vec3(1.0)));
    }
    Density all = row[0];
    for (int k = 1; k < count; ++k) all = all | row[std::size_t(k)];
    return flatten(Solid::rounded(0.05, all));
}

// Time against n half-spaces; the paper measured n^1.3.
void half_spaces(benchmark::State& state) {
    const SolidTree tree = boxes(int(state.range(0)) / 6);
    const Box box = polygonization_box(tree);
    std::size_t triangles = 0;
    for (auto _ : state) triangles = triage(tree, box).triangles.size();
    state.counters["triangles"] = double(triangles);
    state.SetComplexityN(state.range(0));
}
BENCHMARK(half_spaces)
    ->Arg(6)->Arg(60)->Arg(600)->Arg(6000)
    ->Unit(benchmark::kMillisecond)
    ->Complexity(benchmark::oNLogN);

// Lobb's obj4, r in thousandths.
void against_marching_cubes(benchmark::State& state) {
    const double r = 0.001 * double(state.range(0));
    const SolidTree tree = flatten(Solid::rounded(
        r, Density::box(Vec3(0.0), Vec3(1.0)) -
               Density::half_space({0, 1, 0}, 1) * Density::box({0.25, 0.8, 0.25}, {0.75, 1.8, 0.75})));
    const Box box = polygonization_box(tree);
    Mesh by_triage, by_cubes;
    for (auto _ : state) {
        const Ratio ratio = ratio_of([&] { by_cubes = marching_cubes(tree, box, r / 2); },
                                     [&] { by_triage = triage(tree, box); }, 3);
        state.counters["ratio"] = ratio.value();
        state.counters["triage_ms"] = 1e3 * ratio.b;
        state.counters["cubes_ms"] = 1e3 * ratio.a;
    }
    state.counters["triage_triangles"] = double(by_triage.triangles.size());
    state.counters["cubes_triangles"] = double(by_cubes.triangles.size());
    state.counters["triage_distance_r"] = measure(by_triage, tree).distance.max / r;
    state.counters["cubes_distance_r"] = measure(by_cubes, tree).distance.max / r;
}
BENCHMARK(against_marching_cubes)->Arg(50)->Arg(10)->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
