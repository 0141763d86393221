// Instancing against one BSP of all solids, ray by ray.
#include "raytracer/trace/instances.hpp"

#include "ball_field.hpp"
#include "catch.hpp"
#include "raytracer/trace/hits.hpp"
#include "raytracer/trace/implicit_tracer.hpp"
#include "raytracer/trace/surface_tracer.hpp"

using namespace deburr;

namespace {

Affine shift(double x, double y, double z) { return {Mat3(1.0), {x, y, z}}; }
Affine scale(double x, double y, double z) { return {Mat3(x, 0, 0, 0, y, 0, 0, 0, z), Vec3(0)}; }

Affine turn(double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {Mat3(c, s, 0, -s, c, 0, 0, 0, 1), Vec3(0)};
}

Solid block(double r = 0.1) { return Solid::rounded(r, Density::box(Vec3(-0.5), Vec3(0.5))); }

struct Same {
    int hits = 0, misses = 0;
};

// Compares rays from points in and around the box [lo, hi] towards points in it; half of them are parallel to an axis.
Same same_as_one_bsp(const std::vector<Solid>& solids, Vec3 lo, Vec3 hi, int rays = 4000) {
    const ImplicitTracer tracer(solids);
    const SurfaceTracer plain(build_bsp(solids), Criterion::exact);
    Same all;
    int differ = 0;
    for (const auto seed : seeds(rays)) {
        Gen g(seed);
        const auto point = [&](double reach) {
            const Vec3 share(g.between(-reach, 1 + reach), g.between(-reach, 1 + reach), g.between(-reach, 1 + reach));
            return lo + share * (hi - lo);
        };
        const Vec3 from = point(g.chance(0.5) ? 1 : 0), to = point(0);
        Vec3 direction = glm::normalize(to - from);
        if (g.chance(0.5)) {
            direction = Vec3(0);
            direction[g.below(3)] = g.chance(0.5) ? 1 : -1;
        }
        const Ray ray{from, direction};
        const double t_max = g.chance(0.2) ? glm::length(hi - lo) * g.number() : infinity;
        TraceCounters counters;
        const Hit hit = tracer.closest_hit(ray, t_max, counters);
        const FoundSurface want = plain.closest_hit(ray, t_max, counters);
        const double t = want.crossing.t;
        bool same = (hit.t < infinity) == (t < infinity) && tracer.any_hit(ray, t_max, counters) == (t < infinity);
        if (same && hit) {
            same = std::abs(hit.t - t) <= 1e-9 && glm::length(hit.normal - want.crossing.normal) <= 1e-6 &&
                   hit.solid == want.solid && hit.material == want.crossing.material;
            // A ray that leaves the surface does not meet it again at once.
            const Hit next = tracer.closest_hit(leave(hit, hit.normal), infinity, counters);
            same &= !(next.t < 1e-9);
        }
        if (!same) {
            UNSCOPED_INFO("seed " << seed << ": t " << hit.t << ", not " << t << "; solid " << hit.solid << ", not "
                                  << want.solid << "; material " << hit.material << ", not " << want.crossing.material);
            ++differ;
        }
        ++(t < infinity ? all.hits : all.misses);
    }
    CHECK(differ == 0);
    return all;
}

BspStatistics statistics(const std::vector<Solid>& solids) { return ImplicitTracer(solids).statistics(); }

}  // namespace

TEST_CASE("equal solids share a space, however the scene came to them") {
    const Solid one = block();
    const Density cube = Density::box(Vec3(-0.5), Vec3(0.5));
    std::vector<Solid> solids;
    for (int i = 0; i < 5; ++i) {
        const Affine place = compose(shift(2 * i, 0, 0), turn(i));
        solids.push_back(one.transformed(place));                                           // copies of one value
        solids.push_back(block().material(3).transformed(compose(shift(0, 3, 0), place)));  // made anew by a function
        solids.push_back(
            Solid::rounded(0.1, cube.transformed(compose(shift(0, 6, 0), place))));  // transformed, then rounded
    }
    CHECK(statistics(solids).prototypes == 2);
    CHECK(statistics(solids).instances == 15);
    // A cube that is scaled before it is rounded is another solid.
    solids.push_back(Solid::rounded(0.1, cube.transformed(compose(shift(0, 9, 0), scale(2, 2, 2)))));
    solids.push_back(block(0.2).transformed(shift(5, 9, 0)));
    CHECK(statistics(solids).prototypes == 4);
    // So is a cube that is rounded in another way.
    const Solid truly = Solid::convolved(0.1, cube);
    CHECK(statistics({one, truly.transformed(shift(3, 0, 0)), truly.transformed(shift(6, 0, 0))}).prototypes == 3);
    const Same same = same_as_one_bsp(solids, {-1, -1, -1}, {10, 10, 1});
    CHECK(same.hits > 1000);
    CHECK(same.misses > 500);
}

TEST_CASE("placed by any map, over a ground plane, with materials of their own") {
    const Solid handle =
        block(0.05).material(2) | block(0.05).transformed(compose(shift(0, 0.9, 0), scale(0.4, 1, 0.4)));
    std::vector<Solid> solids{Solid::sharp(Density::half_space({0, 1, 0}, -0.5)).material(7)};
    for (int i = 0; i < 60; ++i) {
        Gen g(std::uint64_t(i) + 1);
        Affine place = g.map();
        place.shift = Vec3(2.5 * (i % 8), 0, 2.5 * (i / 8)) + g.point(1);
        const Solid at = handle.transformed(place);
        solids.push_back(i % 3 ? at.material(i % 5) : at);
    }
    const BspStatistics s = statistics(solids);
    CHECK(s.prototypes == 2);
    CHECK(s.instances == 60);
    CHECK(same_as_one_bsp(solids, {-2, -1, -2}, {20, 2, 20}).hits > 2000);
}

TEST_CASE("operands of a union that touch or overlap stay together") {
    const Solid cube = Solid::sharp(Density::box(Vec3(0), Vec3(1)));
    Solid row = cube;
    for (const double x : {1.0, 2.5, 3.4, 5.0, 6.0 + 1e-13, 8.0, 9.0 + 1e-6})
        row = row | cube.transformed(shift(x, 0, 0));
    // 0 and 1, 2.5 and 3.4, and 5 and 6 stay together; 8 and 9 are apart by more than any tolerance.
    const BspStatistics s = statistics({row, block().transformed(shift(0, 3, 0))});
    CHECK(s.instances == 6);
    const Same same = same_as_one_bsp({row, block().transformed(shift(0, 3, 0))}, {-0.5, -0.5, -0.5}, {10.5, 1.5, 1.5});
    CHECK(same.hits > 1000);
    // A ray inside leaves in one step, without hits on walls between the operands.
    TraceCounters counters;
    const ImplicitTracer tracer({row, block().transformed(shift(0, 3, 0))});
    CHECK(std::abs(tracer.closest_hit({{0.5, 0.4, 0.3}, {1, 0, 0}}, infinity, counters).t - 1.5) < 1e-12);
}

TEST_CASE("groups of groups, mirrored, squeezed and far from where they were made") {
    const Solid brick = block(0.07).transformed(shift(1000, 2000, -500));
    Solid row = brick;
    for (int i = 1; i < 6; ++i) row = row | brick.transformed(shift(1.2 * i, 0, 0));
    row = row | block(0.2).transformed(compose(shift(1003, 2001, -500), scale(4, 0.5, 1))).material(4);
    Solid wall = row.material(1);
    for (int i = 1; i < 4; ++i) wall = wall | row.transformed(shift(0.3 * (i % 2), 2.5 * i, 0));
    std::vector<Solid> solids;
    for (int i = 0; i < 6; ++i) {
        const Affine home = compose(compose(scale(i % 2 ? -1 : 1, 1, 0.7), turn(0.4 * i)), shift(-1000, -2000, 500));
        solids.push_back(wall.transformed(compose(shift(0, 0, 2 * i), home)).material(5));
    }
    const BspStatistics s = statistics(solids);
    CHECK(s.instances > 6);
    CHECK(s.instances < 60);
    CHECK(same_as_one_bsp(solids, {-10, -10, -1}, {10, 10, 11}).hits > 500);
}

TEST_CASE("random solids, each placed several times, overlapping at random") {
    int hits = 0;
    for (const auto seed : seeds(40)) {
        CAPTURE(seed);
        Gen g(seed);
        std::vector<Solid> solids;
        for (int k = 0; k < 3; ++k) {
            Solid form = Solid::rounded(g.radius(), g.boolean(2)).material(k + 1);
            if (g.chance(0.5)) form = form - Solid::rounded(g.radius(), g.boolean(1));
            if (g.chance(0.3)) form = form | Solid::rounded(g.radius(), g.box()).transformed(shift(3, 0, 0));
            for (int i = 0; i < 4; ++i) solids.push_back(form.transformed(compose(shift(2 * i, 1.5 * k, 0), g.map())));
        }
        // Unbounded solids fill half of space.
        hits += same_as_one_bsp(solids, {-2, -2, -2}, {8, 5, 2}, 300).hits;
    }
    CHECK(hits > 4000);
}

TEST_CASE("what occurs once, moved, scaled or turned, large or tiny, near or far, alone or over a floor") {
    int hits = 0;
    for (const auto seed : seeds(60)) {
        CAPTURE(seed);
        Gen g(seed);
        std::vector<Solid> solids;
        if (g.chance(0.5)) solids.push_back(Solid::sharp(Density::half_space({0, 1, 0}, -1)));
        const int count = 2 + g.below(6);
        for (int i = 0; i < count; ++i) {
            Solid form =
                Solid::rounded(g.radius() * (1 + 0.1 * i), g.boolean(1) & Density::box(Vec3(-2), Vec3(2))).material(i);
            if (g.chance(0.3)) form = form - Solid::rounded(g.radius(), g.boolean(1));
            const double size = g.chance(0.2) ? std::pow(10.0, g.between(-5, 0)) : 1;
            Affine map = compose(shift(g.between(-3, 3), g.number(), g.between(-3, 3)),
                                 scale(size, size * (g.chance(0.5) ? -1 : 0.7), size));
            if (g.chance(0.3)) map = compose(map, turn(g.between(0, 6)));
            if (g.chance(0.1)) map.shift.x += 1e4;
            solids.push_back(form.transformed(map));
            if (g.chance(0.2)) solids.push_back(form.transformed(compose(shift(0.31, 2, -0.17), map)));
        }
        hits += same_as_one_bsp(solids, {-4, -2, -4}, {4, 4, 4}, 300).hits;
    }
    CHECK(hits > 4000);
}

TEST_CASE("what a map squeezes too much, or nothing bounds, is in the world's own BSP") {
    std::vector<Solid> solids{Solid::sharp(Density::half_space({0, 1, 0}, 0)), block().transformed(scale(1, 1e-4, 1)),
                              block().transformed(shift(3, 0, 0)),
                              Solid::sharp(Density::box(Vec3(0), Vec3(1)) * Density::half_space({1, 0, 0}, -1))};
    CHECK(statistics(solids).instances == 1);
    CHECK(same_as_one_bsp(solids, {-1, -1, -1}, {4, 1, 1}).hits > 1000);
}

TEST_CASE("fields are forms of their own") {
    std::vector<Solid> solids;
    const auto ball = Solid::of_field(std::make_shared<BallField>());
    for (int i = 0; i < 4; ++i)
        solids.push_back(ball.transformed(compose(shift(2.5 * i, 0, 0), scale(1, 0.3 + 0.2 * i, 0.8))).material(i));
    solids.push_back(block() | block().transformed(shift(0, 0, 3)) | ball.transformed(shift(0, 4, 0)));
    CHECK(statistics(solids).instances == 7);
    CHECK(statistics(solids).prototypes == 3);
    CHECK(statistics({ball, Solid::of_field(std::make_shared<BallField>()).transformed(shift(3, 0, 0))}).prototypes ==
          3);
    CHECK(same_as_one_bsp(solids, {-1, -1, -1}, {9, 5, 4}).hits > 500);
}

TEST_CASE("cells of a body with many facets know few of them") {
    std::vector<Density> facets;
    for (int i = 0; i < 600; ++i) {
        const double z = 1 - (2 * i + 1) / 600.0, r = std::sqrt(1 - z * z), a = 2.399963 * i;
        facets.push_back(Density::half_space({r * std::cos(a), z, r * std::sin(a)}, 1));
    }
    CHECK(statistics({Solid::rounded(0.01, Density::product(facets))}).mean_local_half_spaces < 60);
}

TEST_CASE("spaces do not depend on the number of threads") {
    std::vector<Solid> solids;
    for (int i = 0; i < 9000; ++i)
        solids.push_back(block(0.05 + 0.01 * (i % 7))
                             .transformed(compose(shift(i % 20, i / 20 % 20, i / 400), scale(0.4, 0.5, 0.3))));
    Density many = Density::box({0, 0, -3}, {0.5, 0.5, -2.5});  // this solid is built in parallel
    for (int i = 1; i < 300; ++i)
        many = many | Density::box({0.7 * (i % 20), i / 20, -3}, {0.7 * (i % 20) + 0.8, i / 20 + 0.5, -2.5});
    solids.push_back(Solid::rounded(0.04, many));
    const auto hits = [&](std::size_t threads) { return random_hits(threads, [&] { return ImplicitTracer(solids); }); };
    const auto one = hits(1);
    CHECK(one == hits(2));
    CHECK(one == hits(5));
}

TEST_CASE("a hundred thousand placements cost a ray no more than three times what a hundred do") {
    const auto placements_per_ray = [](int side, int layers) {
        std::vector<Solid> solids;
        for (int i = 0; i < side * side * layers; ++i)
            solids.push_back(
                block().transformed(compose(shift(i % side, i / side % side, i / side / side), scale(0.6, 0.6, 0.6))));
        const ImplicitTracer tracer(solids);
        CHECK(tracer.statistics().prototypes == 2);
        TraceCounters counters;
        const Vec3 size(side, side, layers);
        for (const auto seed : seeds(2000)) {
            Gen g(seed);
            const Vec3 target = size * Vec3(g.number(), g.number(), g.number());
            const Vec3 eye = 0.5 * size + 2 * glm::length(size) * g.direction();
            tracer.closest_hit({eye, glm::normalize(target - eye)}, infinity, counters);
        }
        return double(counters.instances + counters.cells) / 2000;
    };
    const double few = placements_per_ray(5, 4), many = placements_per_ray(50, 40);
    CHECK(many <= 3 * few);
}

TEST_CASE("unions of unions are placed, not copied: a million blocks are 300 placements") {
    Solid all = block();
    for (int axis = 0; axis < 3; ++axis) {
        const Solid row = all;
        for (int i = 1; i < 100; ++i) {
            Vec3 to(0);
            to[axis] = 2 * i;
            all = all | row.transformed({Mat3(1.0), to});
        }
    }
    CHECK(all.node().leaves == 6e6);
    const ImplicitTracer tracer({all});
    CHECK(tracer.statistics().instances == 300);
    CHECK(tracer.statistics().half_spaces == 6);
    TraceCounters counters;
    CHECK(std::abs(tracer.closest_hit({{100, 80, 300}, {0, 0, -1}}, infinity, counters).t - 101.5) < 1e-9);
    CHECK(!tracer.closest_hit({{101, 81, 300}, {0, 0, -1}}, infinity, counters));
}

TEST_CASE("of thousands of forms those that no ray enters are not built, and the others are right") {
    std::vector<Solid> solids;
    for (int i = 0; i < 1'500; ++i) {
        const Vec3 half(0.3 + 1e-4 * i, 0.4, 0.5 - 1e-4 * i);
        solids.push_back(Solid::rounded(0.1, Density::box(-half, half))
                             .transformed(compose(shift(2 * (i % 40) + 100, 2 * (i / 40), 0), turn(i))));
    }
    const ImplicitTracer tracer(solids);
    const BspStatistics before = tracer.statistics();
    CHECK(before.prototypes == 1'501);
    CHECK(before.half_spaces < 6 * 1'001);
    TraceCounters counters;
    for (int i = 0; i < 10; ++i) CHECK(tracer.closest_hit({{100 + 2 * i, 2 * 37, 9}, {0, 0, -1}}, infinity, counters));
    CHECK(tracer.statistics().half_spaces == before.half_spaces + 6 * 10);
    CHECK(same_as_one_bsp(solids, {99, -1, -1}, {180, 75, 1}, 2'000).hits > 500);
}
