// What the octree costs: with the surface, not with the volume [Vyatkin §5].
#include <benchmark/benchmark.h>

#include "bench/ratio.hpp"
#include "polygonizer/octree.hpp"
#include "polygonizer/octree_cells.hpp"
#include "polygonizer/triage.hpp"

using namespace deburr;

namespace {

SolidTree obj4() {
    return flatten(Solid::rounded(
        0.05, Density::box(Vec3(0.0), Vec3(1.0)) -
                  Density::half_space({0, 1, 0}, 1) * Density::box({0.25, 0.8, 0.25}, {0.75, 1.8, 0.75})));
}

// Step by step, every voxel is asked whether the surface passes: the way that the paper compares with.
std::size_t every_voxel(const SolidTree& solid, const Box& box, double edge) {
    const SurfaceOffset whole(solid);
    std::size_t open = 0;
    const Vec3 size = (box.hi - box.lo) / edge;
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const Vec3 lo = box.lo + edge * Vec3(x, y, z);
                open += whole.decided({lo, lo + Vec3(edge)}) == 0;
            }
    return open;
}

// 2^level cells along the box. tests_times: range tests against the level below, which is 4 for a
// surface and 8 for a volume; cells_ratio: CPU time of every voxel's test to that of the octree's.
void levels(benchmark::State& state) {
    const SolidTree solid = obj4();
    const Box box = polygonization_box(solid);
    const double edge = std::ldexp(box.hi.x - box.lo.x, -int(state.range(0)));
    const std::size_t below = CellTree(solid, box, 2 * edge, 0).range_tests;
    std::size_t tests = 0, voxels = 0, triangles = 0;
    double mesh_seconds = 0;
    for (auto _ : state) {
        const Ratio ratio = ratio_of([&] { voxels = every_voxel(solid, box, edge); },
                                     [&] { tests = CellTree(solid, box, edge, 0).range_tests; }, 3);
        mesh_seconds = cpu_seconds_of([&] { triangles = octree(solid, box, {edge}).triangles.size(); });
        state.counters["cells_ratio"] = ratio.value();
        state.counters["cells_ms"] = 1e3 * ratio.b;
    }
    state.counters["mesh_ms"] = 1e3 * mesh_seconds;
    state.counters["tests"] = double(tests);
    state.counters["tests_times"] = double(tests) / double(below);
    state.counters["open_voxels"] = double(voxels);
    state.counters["triangles"] = double(triangles);
}
BENCHMARK(levels)->DenseRange(4, 7)->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
