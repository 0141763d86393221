// Packets of rays hit what the rays hit alone, bit by bit.
#include "raytracer/trace/implicit_tracer.hpp"

#include "catch.hpp"
#include "plain_round.hpp"
#include "raytracer/render/integrator.hpp"
#include "raytracer/scene/scene_reader.hpp"
#include "raytracer/trace/hits.hpp"

using namespace deburr;

namespace {

Scene example_scene(const std::string& name) { return read_scene(DEBURR_SOURCE_DIR "/scenes/" + name + ".lua", {}); }

// Counts rays that hit, rays that are occluded, and rays whose results differ from those alone.
struct Comparison {
    int rays = 0, hits = 0, occluded = 0, different = 0;

    void compare(const ImplicitTracer& tracer, const std::vector<Ray>& rays_of, const std::vector<double>& t_max) {
        TraceCounters counters;
        std::vector<Hit> together(rays_of.size());
        const std::unique_ptr<bool[]> any(new bool[rays_of.size()]);
        tracer.closest_hits(rays_of, together.data(), counters);
        tracer.any_hits(rays_of, t_max, any.get(), counters);
        for (std::size_t k = 0; k < rays_of.size(); ++k) {
            const bool occludes = tracer.any_hit(rays_of[k], t_max[k], counters);
            different +=
                !same_bits(together[k], tracer.closest_hit(rays_of[k], infinity, counters)) || any[k] != occludes;
            ++rays;
            hits += bool(together[k]);
            occluded += occludes;
        }
    }
};

// Compares packets of more or less coherent rays from anywhere.
void compare_packets(Gen& g, const ImplicitTracer& tracer, Comparison& c) {
    for (int packet = 0; packet < 8; ++packet) {
        std::vector<Ray> rays;
        std::vector<double> t_max;
        const Vec3 eye = g.point(4), aim = g.point(1);
        const double apart = g.chance(0.3) ? 2 : std::pow(10.0, g.between(-6, 0));
        for (int k = 2 + g.below(30); k > 0; --k) {
            Vec3 d = g.chance(0.1) ? g.normal() : aim - eye + g.point(apart);
            if (g.chance(0.02)) d[g.below(3)] = std::nan("");  // finds nothing and must not disturb the others
            rays.push_back({g.chance(0.5) ? eye : eye + g.point(apart), glm::normalize(d)});
            t_max.push_back(g.chance(0.3) ? infinity : g.between(0, 6));
        }
        c.compare(tracer, rays, t_max);
    }
}

}  // namespace

TEST_CASE("rays that are traced together hit what they hit alone, to the bit: pictures and their shadows") {
    for (const char* name : {"first", "csg_examples", "variable_rounding", "hole_punch", "staplers", "bearing", "cone",
                             "figurine", "melting_robot"}) {
        CAPTURE(name);
        const Scene scene = example_scene(name);
        const ImplicitTracer tracer(scene.solids);
        const int width = 97, height = 61;
        const ProjectiveCamera camera(scene.camera, width, height);
        Comparison c;
        Gen g(1);
        const Vec3 light = g.direction();
        for (int y = 0; y < height; y += 4)
            for (int x = 0; x < width; x += 4) {
                std::vector<Ray> rays, shadows;
                TraceCounters counters;
                for (int k = 0; k < 16; ++k) rays.push_back(camera.ray(x + k % 4 + 0.5, y + k / 4 + 0.5));
                for (const Ray& ray : rays)
                    if (const Hit hit = tracer.closest_hit(ray, infinity, counters))
                        shadows.push_back(leave(hit, light));
                c.compare(tracer, rays, std::vector<double>(rays.size(), infinity));
                std::vector<double> t_max;
                for (std::size_t k = 0; k < shadows.size(); ++k)
                    t_max.push_back(g.chance(0.5) ? infinity : g.between(0, 10));
                c.compare(tracer, shadows, t_max);
            }
        CHECK(c.different == 0);
        CHECK(c.hits > c.rays / 10);
    }
}

TEST_CASE("rays that are traced together hit what they hit alone, to the bit: whatever the solids, wherever the rays") {
    Comparison c;
    std::size_t instances = 0;
    for (auto seed : seeds(300)) {
        CAPTURE(seed);
        Gen g(seed);
        std::vector<Solid> solids;
        for (int i = 1 + g.below(3); i > 0; --i) solids.push_back(g.solid(2));
        if (g.chance(0.4))  // equal solids, which are instances of one prototype
            for (int i = 1 + g.below(8); i > 0; --i) solids.push_back(solids[0].transformed(g.map()));
        const ImplicitTracer tracer(solids);
        instances += tracer.statistics().instances;
        compare_packets(g, tracer, c);
    }
    CHECK(instances > 300);
    CHECK(c.different == 0);
    CHECK(c.hits > c.rays / 10);
    CHECK(c.occluded > c.rays / 10);
}

TEST_CASE("rays that are traced together hit what they hit alone, to the bit: round parts of many sizes in one space") {
    Comparison c;
    for (auto seed : seeds(300)) {
        CAPTURE(seed);
        Gen g(seed);
        std::vector<Solid> solids;  // each has its own tolerances
        double size = 1;
        for (int i = 0; i < 3; ++i, size *= 4) {
            const test::RoundCase round = test::round_case(g, 1 + g.below(3));
            const Affine map{Mat3(size), Vec3(0, 0, -size)};
            solids.push_back(Solid::rounded(round.radius, round.density).transformed(map));
        }
        compare_packets(g, ImplicitTracer(solids), c);
    }
    CHECK(c.different == 0);
    CHECK(c.hits > c.rays / 10);
    CHECK(c.occluded > c.rays / 10);
}
