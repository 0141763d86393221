// The cost of the octree: it grows with the surface and not with the volume [Vyatkin §5].
#include <fmt/format.h>

#include <cmath>

#include "bench/sections.hpp"
#include "polygonizer/octree/octree.hpp"
#include "polygonizer/octree/octree_cells.hpp"
#include "polygonizer/triage/triage.hpp"

namespace deburr::bench {

namespace {

SolidTree obj4() {
    return flatten(Solid::rounded(
        0.05, Density::box(Vec3(0.0), Vec3(1.0)) -
                  Density::half_space({0, 1, 0}, 1) * Density::box({0.25, 0.8, 0.25}, {0.75, 1.8, 0.75})));
}

// The method that the paper compares with: tests every voxel for the surface.
std::size_t every_voxel(const SolidTree& solid, const Box& box, double edge) {
    const SignedDistance whole(solid);
    std::size_t open = 0;
    const Vec3 size = (box.hi - box.lo) / edge;
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const Vec3 lo = box.lo + edge * Vec3(x, y, z);
                open += whole.constant_side({lo, lo + Vec3(edge)}) == 0;
            }
    return open;
}

}  // namespace

// With 2^level cells along the box, tests grow by a factor of 4 a level for a surface, and of 8 for a volume.
void octree_against_every_voxel(Report& report) {
    const SolidTree solid = obj4();
    const Box box = polygonization_box(solid);
    std::size_t below = 0;
    for (const int level : {3, 4, 5, 6, 7}) {
        const double edge = std::ldexp(box.hi.x - box.lo.x, -level);
        std::size_t tests = 0, voxels = 0;
        const auto by_octree = [&] { tests = CellTree(solid, box, edge, 0).range_tests; };
        if (level > 3) {
            const std::string name = fmt::format("obj4, {} cells along a side", 1 << level);
            report.ratio(name + ": every voxel's test / the octree's",
                         ratio_of([&] { voxels = every_voxel(solid, box, edge); }, by_octree, 3));
            report.figure(name + ": tests, of those one level above", double(tests) / double(below), "times");
            report.figure(name + ": mesh", 1e3 * cpu_seconds_of([&] { octree(solid, box, {edge}); }), "ms");
            report.figure(name + ": voxels that the surface may pass", double(voxels), "");
        } else {
            by_octree();
        }
        below = tests;
    }
}

}  // namespace deburr::bench
