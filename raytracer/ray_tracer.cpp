#include "raytracer/ray_tracer.hpp"

namespace deburr {

TraceCounters& TraceCounters::operator+=(const TraceCounters& o) {
    rays += o.rays;
    shadow_rays += o.shadow_rays;
    placements += o.placements;
    cells += o.cells;
    flat_hits += o.flat_hits;
    segments += o.segments;
    splits += o.splits;
    evaluations += o.evaluations;
    return *this;
}

}  // namespace deburr
