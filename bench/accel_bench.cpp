// Embree's BVH against Bvh8 for finding exact surfaces: the same rays with the same hits.
#include <fmt/format.h>

#include "bench/blocks.hpp"
#include "bench/picture.hpp"
#include "bench/sections.hpp"
#include "raytracer/trace/implicit_tracer.hpp"

namespace deburr::bench {
namespace {

ImplicitTracer by_embree(const std::vector<Solid>& solids) {
    return ImplicitTracer(solids, Criterion::exact, RootMethod::where_needed, Accel::embree);
}

// Traces all rays one by one, even if they are passed together.
class RaysAlone final : public RayTracer {
public:
    explicit RaysAlone(const RayTracer& tracer) : tracer_(tracer) {}
    Hit closest_hit(const Ray& ray, double t_max, TraceCounters& counters) const override {
        return tracer_.closest_hit(ray, t_max, counters);
    }
    bool any_hit(const Ray& ray, double t_max, TraceCounters& counters) const override {
        return tracer_.any_hit(ray, t_max, counters);
    }

private:
    const RayTracer& tracer_;
};

}  // namespace

void embree_against_boxes(Report& report) {
    TraceCounters counters;
    for (const char* name : {"csg_examples", "variable_rounding", "staplers"}) {
        const Scene scene = scene_of(name);
        const ImplicitTracer boxes(scene.solids), embree = by_embree(scene.solids);
        const Recording recording(boxes);
        render_picture(scene, recording, counters);
        const RaysAlone alone(boxes), embree_alone(embree);
        report.ratio(fmt::format("{}: rays one by one, by Embree's BVH / by boxes", name),
                     ratio_of([&] { recording.ask(embree_alone, counters); }, [&] { recording.ask(alone, counters); }));
        report.ratio(fmt::format("{}: as a picture asks, which boxes lead together", name),
                     ratio_of([&] { recording.ask(embree, counters); }, [&] { recording.ask(boxes, counters); }));
    }
    constexpr int count = 10'000, rays = 200'000;
    const std::vector<Solid> solids = blocks(count);
    const std::vector<Ray> all = rays_through(std::cbrt(count), rays);
    const ImplicitTracer boxes(solids), embree = by_embree(solids);
    const auto ask = [&](const RayTracer& tracer) {
        for (const Ray& ray : all) keep(tracer.closest_hit(ray, infinity, counters));
    };
    report.ratio("10,000 blocks: rays one by one, by Embree's BVH / by boxes",
                 ratio_of([&] { ask(embree); }, [&] { ask(boxes); }));
}

}  // namespace deburr::bench
