// Hits compared bit by bit.
#pragma once
#include <tbb/global_control.h>

#include <tuple>

#include "random_case.hpp"
#include "raytracer/trace/ray_tracer.hpp"

namespace deburr {

inline bool same_bits(const Hit& a, const Hit& b) {
    if (!a && !b) return true;
    return a.t == b.t && a.position == b.position && a.normal == b.normal && a.solid == b.solid &&
           a.material == b.material && a.offset == b.offset;
}

/// Sum of the hits' distances over 2,000 random rays, with the counters of the queries. make() makes the tracer while
/// at most `threads` threads run.
template <class Make>
auto random_hits(std::size_t threads, Make make) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const auto tracer = make();
    TraceCounters counters;
    double sum = 0;
    for (const auto seed : seeds(2000)) {
        Gen g(seed);
        const Hit hit = tracer.closest_hit({g.point(30), g.direction()}, infinity, counters);
        if (hit) sum += hit.t;
    }
    return std::make_tuple(sum, counters.instances, counters.cells, counters.evaluations);
}

}  // namespace deburr
