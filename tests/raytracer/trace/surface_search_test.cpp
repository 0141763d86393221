// SurfaceSearch: the surface found does not depend on the order of the candidates.
#include "raytracer/trace/surface_search.hpp"

#include <algorithm>
#include <numeric>

#include "ball_field.hpp"
#include "catch.hpp"
#include "random_case.hpp"
#include "raytracer/trace/implicit_tracer.hpp"
#include "raytracer/trace/surface_tracer.hpp"

using namespace deburr;

namespace {

bool same_surface(const FoundSurface& a, const FoundSurface& b) {
    return a.crossing.t == b.crossing.t && a.crossing.normal == b.crossing.normal && a.solid == b.solid &&
           a.crossing.material == b.crossing.material && a.error == b.error;
}

// Solids that overlap, some with coincident faces, and some equal to another.
std::vector<Solid> crowd(Gen& g) {
    std::vector<Solid> solids;
    const Solid within = Solid::sharp(Density::box(Vec3(-2), Vec3(2)));
    for (int i = 0; i < 4; ++i) {
        solids.push_back((g.solid(g.below(2)) & within).material(i));
        if (g.chance(0.3)) solids.push_back(g.solid(0).material(10 + i));  // may be unbounded
        if (g.chance(0.5)) solids.push_back(solids.back().material(20 + i));
        if (g.chance(0.2)) solids.push_back(Solid::of_field(std::make_shared<BallField>()).material(30 + i));
    }
    return solids;
}

}  // namespace

TEST_CASE("the surface found is the same to the bit in whatever order surfaces are looked at, through a BSP or not",
          "[slow]") {
    int hits = 0, ties = 0;
    for (const auto seed : seeds(1500)) {
        CAPTURE(seed);
        Gen g(seed);
        const std::vector<Solid> solids = crowd(g);
        BspTree tree = build_bsp(solids);
        const std::vector<BspNode> nodes = tree.nodes;
        const SurfaceTracer tracer(std::move(tree), Criterion::exact);
        const Surfaces& all = tracer.surfaces();
        std::vector<std::uint32_t> order(all.cell_primitives.size());
        std::iota(order.begin(), order.end(), 0);
        for (int k = 0; k < 40; ++k) {
            Vec3 from = g.chance(0.2) ? g.point(1) : g.point(4);
            Vec3 d = glm::normalize(g.point(1) - from);
            if (g.chance(0.5)) {  // in the walls between cells, and where walls meet
                d = Vec3(0);
                const int axis = g.below(3);
                d[axis] = g.chance(0.5) ? 1 : -1;
                from = g.point(1.5);
                for (int n = 0; n < 4; ++n) {
                    const BspNode& node = nodes[g.below(int(nodes.size()))];
                    if (node.axis < 3 && node.axis != axis) from[node.axis] = node.split;
                }
                from[axis] = -4 * d[axis];
            }
            const Ray ray{from, d};
            const double t_max = g.chance(0.3) ? g.between(0, 6) : infinity;
            TraceCounters counters;
            const FoundSurface want = tracer.closest_hit(ray, t_max, counters);
            bool tie = false;
            for (int round = 0; round < 3; ++round) {
                for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[g.below(int(i))]);
                SurfaceSearch<false> search(all, ray, t_max, infinity, counters, nullptr);
                SurfaceSearch<true> any(all, ray, t_max, infinity, counters, nullptr);
                if (g.chance(0.5)) search.visit_planes();
                const int twice = g.below(4);  // visits some twice, as two cells may share a surface
                for (const std::uint32_t i : order)
                    for (int n = 0; n < (i % 4 == std::uint32_t(twice) ? 2 : 1); ++n) search.visit(i);
                search.visit_planes();
                any.visit_planes();
                for (std::size_t i = 0; i < order.size() && !any.enough(); ++i) any.visit(order[i]);
                const FoundSurface found = search.found() ? search.surface() : FoundSurface{};
                CAPTURE(found.crossing.t - want.crossing.t, found.solid, want.solid, found.error - want.error);
                REQUIRE(same_surface(found, want));
                REQUIRE(any.found() == (want.crossing.t < infinity));
                for (const std::uint32_t i : order) {
                    if (!(want.crossing.t < infinity)) break;
                    SurfaceSearch<false> alone(all, ray, t_max, infinity, counters, nullptr);
                    alone.visit(i);
                    tie |= alone.found() && alone.end() == want.crossing.t && alone.surface().solid != want.solid;
                }
            }
            hits += want.crossing.t < infinity;
            ties += tie;
        }
    }
    CHECK(hits > 20'000);
    CHECK(ties > 3'000);
}

TEST_CASE("of crossings at one place the lower solid has it, and in one solid the lower number") {
    struct SamePlace final : InstanceTracer {
        FoundSurface closest_hit(std::uint32_t other, const Ray&, double, double, TraceCounters&) const override {
            const int solids[4] = {3, 2, 1, 1};
            return {{1.5, Vec3(1, 0, 0), int(other)}, solids[other]};
        }
        bool any_hit(std::uint32_t, const Ray&, double, TraceCounters&) const override { return true; }
    };
    const Surfaces none;
    const SamePlace instances;
    const Ray ray{Vec3(0), Vec3(1, 0, 0)};
    std::vector<std::uint32_t> order{0, 1, 2, 3};
    do {
        TraceCounters counters;
        SurfaceSearch<false> search(none, ray, infinity, infinity, counters, &instances);
        for (const std::uint32_t i : order) search.visit(i);
        REQUIRE(search.found());
        CHECK(search.surface().crossing.material == 2);
    } while (std::next_permutation(order.begin(), order.end()));
}
