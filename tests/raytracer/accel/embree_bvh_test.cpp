// Tracing through Deburr's BVH and through Embree's gives the same hits, bit by bit.
#include <algorithm>
#include <filesystem>

#include "ball_field.hpp"
#include "catch.hpp"
#include "raytracer/render/integrator.hpp"
#include "raytracer/scene/scene_reader.hpp"
#include "raytracer/trace/hits.hpp"
#include "raytracer/trace/implicit_tracer.hpp"

using namespace deburr;

namespace {

// Compares tracers of both kinds for the same solids.
class Roads {
public:
    explicit Roads(const std::vector<Solid>& solids)
        : bsp_(solids), embree_(solids, Criterion::exact, RootMethod::where_needed, Accel::embree) {}

    /// Checks the closest hit of the ray and, from there, rays to `light`, in the mirrored direction and straight on.
    void follow(const Ray& ray, double t_max, Vec3 light) {
        const Hit hit = check(ray, t_max);
        if (!hit) return;
        check(leave(hit, glm::normalize(light - hit.position)), glm::length(light - hit.position));
        check(leave(hit, ray.direction - 2 * glm::dot(ray.direction, hit.normal) * hit.normal), infinity);
        check(leave(hit, ray.direction), infinity);
    }

    int hits = 0, rays = 0;

private:
    Hit check(const Ray& ray, double t_max) {
        TraceCounters counters;
        const Hit want = bsp_.closest_hit(ray, t_max, counters), hit = embree_.closest_hit(ray, t_max, counters);
        CAPTURE(ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x, ray.direction.y, ray.direction.z, t_max,
                want.t, hit.t);
        REQUIRE(same_bits(hit, want));
        REQUIRE(embree_.any_hit(ray, t_max, counters) == bsp_.any_hit(ray, t_max, counters));
        ++rays;
        hits += bool(want);
        return want;
    }

    ImplicitTracer bsp_, embree_;
};

// Compares rays that start in or around [−reach, reach]³; half of them are parallel to an axis, some come from far
// away.
void follow_any(Roads& roads, Gen& g, double reach, int rays) {
    for (int k = 0; k < rays; ++k) {
        Vec3 from = g.point(g.chance(0.3) ? reach : 3 * reach);
        Vec3 d = glm::normalize(g.point(reach) - from);
        if (g.chance(0.5)) {
            d = Vec3(0);
            d[g.below(3)] = g.chance(0.5) ? 1 : -1;
            if (g.chance(0.5)) from = 0.25 * glm::round(4.0 * from);  // may lie in a face
        }
        if (g.chance(0.1)) from -= d * (reach * std::pow(10.0, g.between(0, 6)));
        roads.follow({from, d}, g.chance(0.2) ? 4 * reach * g.number() : infinity, g.point(3 * reach));
    }
}

}  // namespace

TEST_CASE("the scenes: camera rays, shadow rays and reflections hit the same to the bit", "[slow]") {
    int scenes = 0;
    for (const auto& file : std::filesystem::directory_iterator(DEBURR_SOURCE_DIR "/scenes")) {
        if (file.path().extension() != ".lua") continue;
        CAPTURE(file.path().string());
        const Scene scene = read_scene(file.path());
        Roads roads(scene.solids);
        const ProjectiveCamera camera(scene.camera, 60, 40);
        for (int y = 0; y < 40; ++y)
            for (int x = 0; x < 60; ++x)
                roads.follow(camera.ray(x + 0.5, y + 0.5), infinity, scene.camera.eye + Vec3(1, 5, -2));
        CHECK(roads.hits > 500);
        ++scenes;
    }
    CHECK(scenes > 10);
}

TEST_CASE("random solids and fields, many in one space, unbounded or placed again and again, hit the same to the bit") {
    int hits = 0;
    for (const auto seed : seeds(100)) {
        CAPTURE(seed);
        Gen g(seed);
        std::vector<Solid> solids;
        for (int i = 0; i < 4; ++i) {
            const Solid solid = g.solid(g.below(3)).material(i);
            solids.push_back(solid);
            const int again = g.chance(0.5) ? g.below(8) : 0;
            for (int n = 0; n < again; ++n) {
                Affine map = g.map();
                map.shift = g.point(3);
                solids.push_back(solid.transformed(map));
            }
            if (g.chance(0.3)) solids.push_back(solid.material(10 + i));  // coincides with the solid
            if (g.chance(0.2))
                solids.push_back(Solid::of_field(std::make_shared<BallField>()).transformed({Mat3(0.7), g.point(2)}));
        }
        Roads roads(solids);
        follow_any(roads, g, 4, 60);
        hits += roads.hits;
    }
    CHECK(hits > 8'000);
}

TEST_CASE("tiny, huge and far away, in placements of placements, hits are the same to the bit") {
    int hits = 0;
    for (const auto seed : seeds(60)) {
        CAPTURE(seed);
        Gen g(seed);
        const Solid block = Solid::rounded(0.1, g.boolean(2) & Density::box(Vec3(-1), Vec3(1)));
        Solid row = block;
        for (int i = 1; i < 8; ++i) row = row | block.transformed({Mat3(1.0), Vec3(2.5 * i, 0, 0)});
        const double size = std::pow(10.0, g.between(-6, 6));
        const Vec3 away = g.chance(0.5) ? Vec3(0) : g.point(1e4) * size;
        std::vector<Solid> solids;
        for (int i = 0; i < 9; ++i) {
            Affine map = g.map();
            map.linear *= size * (g.chance(0.2) ? std::pow(10.0, g.between(-6, 0)) : 1);
            map.shift = away + g.point(10) * size;
            solids.push_back(row.transformed(map).material(i));
        }
        Roads roads(solids);
        for (int k = 0; k < 200; ++k) {
            const Vec3 from = away + g.point(30) * size, to = away + g.point(15) * size;
            roads.follow({from, glm::normalize(to - from)}, infinity, away + g.point(30) * size);
        }
        hits += roads.hits;
    }
    CHECK(hits > 2'000);
}

TEST_CASE("what Embree leads rays to does not depend on the number of threads") {
    std::vector<Solid> solids;
    for (int i = 0; i < 6000; ++i) {
        const Density box = Density::box(Vec3(0), Vec3(0.4, 0.5, 0.3 + 0.01 * (i % 10)));
        solids.push_back(Solid::rounded(0.05, box).transformed({Mat3(1.0), Vec3(i % 20, i / 20 % 20, i / 400)}));
    }
    const auto work = [&](std::size_t threads) {
        return random_hits(
            threads, [&] { return ImplicitTracer(solids, Criterion::exact, RootMethod::where_needed, Accel::embree); });
    };
    const auto one = work(1);
    CHECK(one == work(2));
    CHECK(one == work(5));
}
