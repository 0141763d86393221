// BspStore: BSPs are reused after an edit of the scene.
#include "raytracer/trace/bsp_store.hpp"

#include <bit>

#include "catch.hpp"
#include "raytracer/trace/hits.hpp"
#include "raytracer/trace/implicit_tracer.hpp"

using namespace deburr;

namespace {

constexpr int block_count = 24;

// Blocks with a hole each on the ground; the hole of block `edited` is wider, and block `moved` is moved by `by`.
std::vector<Solid> workbench(int edited = -1, int moved = -1, double by = 0) {
    std::vector<Solid> solids = {Solid::sharp(Density::half_space({0, 1, 0}, 0))};
    for (int i = 0; i < block_count; ++i) {
        const double width = 0.2 + 0.01 * i + (i == edited ? 0.105 : 0.0);
        const Density hole = Density::box({-width, 0.5, -width}, {width, 2, width});
        const Solid block = Solid::rounded(0.05, Density::box({-0.5, 0, -0.5}, {0.5, 1, 0.5}) - hole);
        const Vec3 place(1.5 * (i % 6) + (i == moved ? by : 0.0), 0, 1.5 * (i / 6));
        solids.push_back(block.transformed({Mat3(1.0), place}).material(i % 3));
    }
    return solids;
}

ImplicitTracer tracer_of(const std::vector<Solid>& solids, BspStore* store) {
    return ImplicitTracer(solids, Criterion::exact, RootMethod::where_needed, Accel::bvh, store);
}

// Number of rays that hit, if the hits with and without the store have the same bits; 0 if any differ.
int same_hits(const std::vector<Solid>& solids, BspStore& store) {
    const ImplicitTracer with = tracer_of(solids, &store), without = tracer_of(solids, nullptr);
    int hits = 0;
    for (const auto seed : seeds(2'000)) {
        Gen g(seed);
        const Vec3 from(g.between(-2, 10), g.between(0.1, 4), g.between(-2, 7));
        const Vec3 to(g.between(0, 8), g.between(0, 1), g.between(0, 5));
        TraceCounters a, b;
        const Hit x = with.closest_hit({from, glm::normalize(to - from)}, infinity, a);
        const Hit y = without.closest_hit({from, glm::normalize(to - from)}, infinity, b);
        if (std::bit_cast<std::uint64_t>(x.t) != std::bit_cast<std::uint64_t>(y.t) || x.normal != y.normal ||
            x.solid != y.solid || x.material != y.material || a.evaluations != b.evaluations)
            return 0;
        hits += bool(x);
    }
    return hits;
}

}  // namespace

TEST_CASE("what an edit leaves as it was is not built again") {
    BspStore store;
    CHECK(same_hits(workbench(), store) > 1'000);
    CHECK(store.kept() == 0);
    const std::size_t all = store.built();
    CHECK(all == block_count + 1);
    CHECK(same_hits(workbench(), store) > 1'000);  // the same scene read again
    CHECK(store.kept() == all);
    CHECK(store.built() == 0);
    CHECK(same_hits(workbench(7), store) > 1'000);
    CHECK(store.kept() == all - 1);
    CHECK(store.built() == 1);
    CHECK(same_hits(workbench(7, 3, 0.01), store) > 1'000);
    CHECK(store.built() == 1);
    CHECK(same_hits(workbench(), store) > 1'000);  // BSPs of earlier scenes were dropped
    CHECK(store.built() == 2);
}

TEST_CASE("a scene that an edit makes much larger is built for its own scale") {
    BspStore store;
    CHECK(same_hits(workbench(), store) > 1'000);
    CHECK(same_hits(workbench(-1, 5, 1e5), store) > 1'000);
    CHECK(store.built() > block_count / 2);  // its tolerances are others
    CHECK(same_hits(workbench(-1, 5, 1e5), store) > 1'000);
    CHECK(store.built() == 0);
}
