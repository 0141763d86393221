#include "raytracer/trace/ray_tracer.hpp"

namespace deburr {

TraceCounters& TraceCounters::operator+=(const TraceCounters& o) {
    rays += o.rays;
    shadow_rays += o.shadow_rays;
    instances += o.instances;
    cells += o.cells;
    flat_hits += o.flat_hits;
    segments += o.segments;
    splits += o.splits;
    evaluations += o.evaluations;
    return *this;
}

void RayTracer::closest_hits(std::span<const Ray> rays, Hit* hits, TraceCounters& counters) const {
    for (std::size_t k = 0; k < rays.size(); ++k) hits[k] = closest_hit(rays[k], infinity, counters);
}

void RayTracer::any_hits(std::span<const Ray> rays, std::span<const double> t_max, bool* occluded,
                         TraceCounters& counters) const {
    for (std::size_t k = 0; k < rays.size(); ++k) occluded[k] = this->any_hit(rays[k], t_max[k], counters);
}

}  // namespace deburr
