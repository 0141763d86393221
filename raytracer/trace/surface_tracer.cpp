#include "raytracer/trace/surface_tracer.hpp"

#include <algorithm>

#include "raytracer/trace/packet_search.hpp"

namespace deburr {
namespace {

// A node to visit, and the ray's interval in it.
struct Visit {
    int node;
    double t0, t1;
};

// Calls cell(number, t) for the cells that the ray passes in [t0, t1], where t is the parameter of entry, in order; a
// ray within a wall passes the cells on both sides one after the other. Once a call returns true, no cell that is
// entered there or later is visited.
template <class OnCell>
void traverse(const BspTree& tree, const Ray& ray, double t0, double t1, OnCell on_cell) {
    Visit stack[128];
    int top = 0;
    Visit now{0, t0, t1};
    for (;;) {
        const BspNode& node = tree.nodes[now.node];
        if (node.axis == 3) {
            if (on_cell(std::size_t(node.child), now.t0))
                while (top > 0 && stack[top - 1].t0 >= now.t0) --top;
            if (top == 0) return;
            now = stack[--top];
            continue;
        }
        const double o = ray.origin[node.axis], d = ray.direction[node.axis];
        if (d == 0) {
            if (o == node.split) stack[top++] = {node.child + 1, now.t0, now.t1};
            now.node = node.child + (o > node.split);
            continue;
        }
        const int near = node.child + (d < 0), far = node.child + (d > 0);
        const double t = (node.split - o) / d;
        if (t >= now.t1) {
            now.node = near;
        } else if (t <= now.t0) {
            now.node = far;
        } else {
            stack[top++] = {far, t, now.t1};
            now = {near, now.t0, t};
        }
    }
}

}  // namespace

template <bool Any>
[[gnu::always_inline]] inline bool SurfaceTracer::search(SurfaceSearch<Any>& search) const {
    search.visit_planes();
    if (search.enough()) return true;
    const Ray& ray = search.ray();
    // A ray with NaN would be let into empty boxes.
    const Vec3 sum = ray.origin + ray.direction;
    if (!(sum == sum)) return false;
    const BoxSpan span = span_in(around_, ray.origin, search.inverse(), search.begin(), search.end());
    const bool meets = !around_.empty() && span.lo <= span.hi;
    if (!bounded_) {
        walk(search, search.begin(), meets ? span.lo : search.end());
        if (search.enough() || (search.found() && search.end() < span.lo)) return true;
    }
    if (!meets) return search.found();
    const auto visit = [&](std::uint32_t i) {
        search.visit(i);
        return search.enough() ? -1.0 : search.end();
    };
    if (!embree_)
        boxes_.visit(ray.origin, ray.direction, search.inverse(), span.lo, span.hi, visit);
    else
        embree_->visit(ray.origin, ray.direction, span.lo, span.hi,
                       Any ? EmbreeBvh::Order::any : EmbreeBvh::Order::nearest_first, visit);
    if (!bounded_ && !search.enough() && search.end() > span.hi) walk(search, span.hi, search.end());
    return search.found();
}

template <bool Any>
void SurfaceTracer::walk(SurfaceSearch<Any>& search, double t0, double t1) const {
    const BspTree& tree = trees_[0];  // whose primitives come first in surfaces_
    traverse(tree, search.ray(), t0, t1, [&](std::size_t number, double from) {
        // A crossing within rounding of a wall may be found in either cell.
        if (search.enough() || from - search.rounding(from) > search.end()) return true;
        const BspCell& cell = tree.cells[number];
        for (std::uint32_t i = cell.first; i < cell.first + cell.count; ++i) search.visit(i);
        return false;
    });
}

FoundSurface SurfaceTracer::closest_hit_nearby(const Ray& ray, double begin, double t_max, TraceCounters& counters,
                                               const InstanceTracer* instances, double end) const {
    SurfaceSearch<false> s(surfaces_, ray, t_max, end, counters, instances, begin);
    return search(s) ? s.surface() : FoundSurface{};
}

bool SurfaceTracer::any_hit_nearby(const Ray& ray, double begin, double t_max, TraceCounters& counters,
                                   const InstanceTracer* instances) const {
    SurfaceSearch<true> s(surfaces_, ray, t_max, t_max, counters, instances, begin);
    return search(s);
}

// ---- far rays ------------------------------------------------------------------------------------

FoundSurface SurfaceTracer::closest_hit_from_afar(const Ray& ray, double t_max, TraceCounters& counters,
                                                  const InstanceTracer* instances, double end) const {
    const double start = vicinity_.start(ray);
    if (start == 0) return closest_hit_nearby(ray, 0, t_max, counters, instances, end);
    const FarRay far(ray, start, t_max, surfaces_.scale);
    if (has_unbounded()) {
        const FoundSurface first = closest_hit_nearby(ray, 0, std::min(t_max, far.middle), counters, instances, end);
        if (first.crossing.t < infinity) return first;
    }
    if (std::min(t_max, end) < far.middle) return {};
    FoundSurface found = closest_hit_nearby(far.moved, far.begin, far.t_max, counters, instances, end - start);
    found.start = start;
    return found;
}

bool SurfaceTracer::any_hit_from_afar(const Ray& ray, double t_max, TraceCounters& counters,
                                      const InstanceTracer* instances) const {
    const double start = vicinity_.start(ray);
    if (start == 0) return any_hit_nearby(ray, 0, t_max, counters, instances);
    const FarRay far(ray, start, t_max, surfaces_.scale);
    if (has_unbounded() && any_hit_nearby(ray, 0, std::min(t_max, far.middle), counters, instances)) return true;
    return t_max >= far.middle && any_hit_nearby(far.moved, far.begin, far.t_max, counters, instances);
}

// ---- packets -------------------------------------------------------------------------------------

namespace {

// Fewer rays than this are traced one by one: a packet would gain nothing.
constexpr std::size_t min_packet_rays = 4;

}  // namespace

bool SurfaceTracer::use_packet(Lanes lanes) const { return count(lanes) >= min_packet_rays && bounded_ && !embree_; }

void SurfaceTracer::closest_hit_packet(const RayPacket& rays, Lanes lanes, PacketSurfaces& found,
                                       TraceCounters& counters, const InstanceTracer* instances) const {
    found.found = 0;
    if (!use_packet(lanes))
        return for_each_lane(lanes, [&](int k) {
            found.set(k, closest_hit(rays.ray(k), rays.t_max[k], counters, instances, rays.end[k]));
        });
    PacketSearch<false> search(surfaces_, rays, lanes, counters, instances, vicinity_.farthest(), found);
    if (search.is_far()) return closest_hit_from_afar(rays, lanes, found, counters, instances);
    search.search(boxes_);
}

Lanes SurfaceTracer::any_hit_packet(const RayPacket& rays, Lanes lanes, TraceCounters& counters,
                                    const InstanceTracer* instances) const {
    if (!use_packet(lanes)) {
        Lanes found = 0;
        for_each_lane(lanes,
                      [&](int k) { found |= Lanes(any_hit(rays.ray(k), rays.t_max[k], counters, instances)) << k; });
        return found;
    }
    PacketSearch<true> search(surfaces_, rays, lanes, counters, instances, vicinity_.farthest());
    if (search.is_far()) return any_hit_from_afar(rays, lanes, counters, instances);
    search.search(boxes_);
    return search.any_hit();
}

namespace {

// The rays of a packet near the prototype's surfaces: those from far away are moved (far_ray.hpp).
struct RaysBeside {
    RayPacket rays;
    Lanes lanes = 0;
    double start[RayPacket::size];

    /// Calls on_the_way(k, until) for every far ray, to search its first part; true means that ray k needs no second
    /// part.
    template <class OnTheWay>
    RaysBeside(const RayPacket& all, Lanes asked, const Vicinity& vicinity, double scale, OnTheWay on_the_way)
        : rays(all) {
        for_each_lane(asked, [&](int k) {
            const Ray ray = all.ray(k);
            const FarRay far(ray, vicinity.start(ray), all.t_max[k], scale);
            if (far.start > 0 && on_the_way(k, far.middle)) return;
            lanes |= Lanes(1) << k;
            start[k] = far.start;
            rays.end[k] = all.end[k] - far.start;
            if (far.start == 0) return;
            for (int axis = 0; axis < 3; ++axis) rays.origin[axis][k] = far.moved.origin[axis];
            rays.begin[k] = far.begin;
            rays.t_max[k] = far.t_max;
            rays.end[k] = std::min(far.t_max, rays.end[k]);
        });
    }
};

}  // namespace

void SurfaceTracer::closest_hit_from_afar(const RayPacket& rays, Lanes lanes, PacketSurfaces& found,
                                          TraceCounters& counters, const InstanceTracer* instances) const {
    const RaysBeside beside(rays, lanes, vicinity_, surfaces_.scale, [&](int k, double middle) {
        if (!has_unbounded()) return false;
        found.set(
            k, closest_hit_nearby(rays.ray(k), 0, std::min(rays.t_max[k], middle), counters, instances, rays.end[k]));
        return (found.found >> k & 1) != 0;
    });
    if (count(beside.lanes) < min_packet_rays)
        return for_each_lane(beside.lanes, [&](int k) {
            found.set(k, closest_hit(rays.ray(k), rays.t_max[k], counters, instances, rays.end[k]));
        });
    PacketSurfaces of_moved;
    PacketSearch<false> search(surfaces_, beside.rays, beside.lanes, counters, instances, infinity, of_moved);
    search.search(boxes_);
    for_each_lane(of_moved.found, [&](int k) {
        found.set(k, of_moved);
        found.start[k] = beside.start[k];
    });
}

Lanes SurfaceTracer::any_hit_from_afar(const RayPacket& rays, Lanes lanes, TraceCounters& counters,
                                       const InstanceTracer* instances) const {
    Lanes found = 0;
    const RaysBeside beside(rays, lanes, vicinity_, surfaces_.scale, [&](int k, double middle) {
        const bool any =
            has_unbounded() && any_hit_nearby(rays.ray(k), 0, std::min(rays.t_max[k], middle), counters, instances);
        found |= Lanes(any) << k;
        return any;
    });
    if (count(beside.lanes) < min_packet_rays) {
        for_each_lane(beside.lanes,
                      [&](int k) { found |= Lanes(any_hit(rays.ray(k), rays.t_max[k], counters, instances)) << k; });
        return found;
    }
    PacketSearch<true> search(surfaces_, beside.rays, beside.lanes, counters, instances, infinity);
    search.search(boxes_);
    return found | search.any_hit();
}

}  // namespace deburr
