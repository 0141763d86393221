// The search for a ray's first crossing among the surfaces of one prototype (instances.hpp), whichever structure visits
// them: the BVH, a BSP, or Embree's BVH.
//
// The result depends neither on the order of visits nor on visits to surfaces that the ray does not cross: a ray's
// crossing of a surface is a function of the two alone, and a fixed rule chooses among several crossings
// (nearest_crossing.hpp).
#pragma once
#include "raytracer/accel/bvh.hpp"
#include "raytracer/trace/nearest_crossing.hpp"
#include "raytracer/trace/packet_surfaces.hpp"

namespace deburr {

/// Traces rays into the instances placed in a prototype. An instance is named by its number there.
class InstanceTracer {
public:
    /// First crossing of a surface of the instance in [0, t_max]; a crossing beyond `end` need not be found.
    virtual FoundSurface closest_hit(std::uint32_t instance, const Ray& ray, double t_max, double end,
                                     TraceCounters& counters) const = 0;
    /// Whether the ray crosses a surface of the instance in [0, t_max].
    virtual bool any_hit(std::uint32_t instance, const Ray& ray, double t_max, TraceCounters& counters) const = 0;
    /// closest_hit() and any_hit() for the rays in `lanes`, with the same results to the bit; crossings of ray k beyond
    /// end[k] need not be found.
    virtual void closest_hit_packet(std::uint32_t instance, const RayPacket& rays, const double* end, Lanes lanes,
                                    PacketSurfaces& found, TraceCounters& counters) const {
        for_each_lane(
            lanes, [&](int k) { found.set(k, closest_hit(instance, rays.ray(k), rays.t_max[k], end[k], counters)); });
    }
    virtual Lanes any_hit_packet(std::uint32_t instance, const RayPacket& rays, Lanes lanes,
                                 TraceCounters& counters) const {
        Lanes found = 0;
        for_each_lane(lanes,
                      [&](int k) { found |= Lanes(any_hit(instance, rays.ray(k), rays.t_max[k], counters)) << k; });
        return found;
    }

protected:
    ~InstanceTracer() = default;
};

/// The surfaces of one prototype. Cell primitives and instances are numbered together, in this order.
struct Surfaces {
    double scale = 1;  // upper bound of coordinates
    CellPrimitives cell_primitives;
    CellPrimitives infinite_planes;   // of solids that are a single half-space
    LargeVector<Box> instance_boxes;  // inflated by more than the rounding of a ray
};

/// Rounding error of a point at distance t along a ray, given the largest coordinate magnitude.
inline double rounding_of(double coordinate_bound, double t) { return 4 * epsilon * (coordinate_bound + std::abs(t)); }

/// Whether the ray crosses primitive i in [from, to]. Unless `Any`, the first crossing is offered to `nearest`, a
/// NearestCrossing or a class with its offer() functions.
template <bool Any, class Nearest>
[[gnu::always_inline]] inline bool intersect_primitive(const CellPrimitives& primitives, std::uint32_t i,
                                                       const Ray& ray, double from, double to, double coordinate_bound,
                                                       Nearest& nearest, TraceCounters& counters) {
    const CellPrimitive& p = primitives[i];
    if (p.kind == CellPrimitive::Kind::plane) {
        const double t = primitives.plane_crossing(p, ray.origin, ray.direction);
        if (!(t >= from && t <= to && t < infinity)) return false;
        ++counters.flat_hits;
        if constexpr (!Any) nearest.offer(primitives, i, {t});
        return true;
    }
    if (p.kind == CellPrimitive::Kind::convex) {
        if constexpr (Any) {
            return primitives.crosses_convex(p, ray.origin, ray.direction, from, to, counters);
        } else {
            const ConvexCrossing c = primitives.convex_crossing(p, ray.origin, ray.direction, from, to, counters);
            if (!(c.t < infinity)) return false;
            nearest.offer(primitives, i, c);
            return true;
        }
    }
    const SurfaceCrossing c = primitives.general_crossing(p, ray.origin, ray.direction, from, to, Any, counters);
    if (!(c.t < infinity)) return false;
    if constexpr (!Any) nearest.offer(c, rounding_of(coordinate_bound, c.t) + c.error, p.solid, i);
    return true;
}

/// A search of one ray; with `Any` an any-hit query, which finds only whether there is a crossing in [begin, t_max].
template <bool Any>
class SurfaceSearch {
public:
    /// A search in [begin, t_max] that need not find crossings beyond `end`. `instances` may be null if there are none.
    SurfaceSearch(const Surfaces& surfaces, const Ray& ray, double t_max, double end, TraceCounters& counters,
                  const InstanceTracer* instances, double begin = 0)
        : surfaces_(surfaces),
          ray_(ray),
          inverse_(reciprocal(ray.direction)),
          coordinate_bound_(surfaces.scale + largest(ray.origin)),
          begin_(begin),
          t_max_(t_max),
          nearest_(std::min(t_max, end)),
          counters_(counters),
          instances_(instances) {}

    const Ray& ray() const { return ray_; }
    const Vec3& inverse() const { return inverse_; }
    bool found() const { return nearest_.found() || any_; }
    double begin() const { return begin_; }
    /// The distance beyond which crossings no longer count.
    double end() const { return nearest_.end(); }
    /// Whether the search can stop: an any-hit query has found a crossing.
    bool enough() const { return any_; }
    /// The rounding error of a point at distance t along the ray.
    double rounding(double t) const { return rounding_of(coordinate_bound_, t); }

    /// Intersects the infinite planes, which are in no BVH.
    void visit_planes() {
        for (std::size_t i = 0; i < surfaces_.infinite_planes.size(); ++i)
            intersect(surfaces_.infinite_planes, std::uint32_t(i), begin_, t_max_);
    }

    /// Intersects cell primitive or instance i.
    void visit(std::uint32_t i) {
        if (i < surfaces_.cell_primitives.size())
            visit_in_cell(i);
        else
            visit_instance(i);
    }

    /// The nearest surface found; its t is infinity if there is none.
    FoundSurface surface() const { return nearest_.surface(ray_, rounding(nearest_.end())); }

private:
    void visit_in_cell(std::uint32_t i) {
        // Up to t_max, not end(): rounding makes the crossing found depend on both ends of the stretch.
        const BoxSpan span = span_in(surfaces_.cell_primitives[i].box, ray_.origin, inverse_, begin_, t_max_);
        // Cells overlap by the rounding of their walls: a surface in a wall belongs to both.
        const double pad = rounding(std::min(span.lo, span.hi));
        const double from = std::max(begin_, span.lo - pad), to = std::min(t_max_, span.hi + pad);
        if (from <= to && from <= end()) intersect(surfaces_.cell_primitives, i, from, to);
    }

    [[gnu::always_inline]] void intersect(const CellPrimitives& primitives, std::uint32_t i, double from, double to) {
        ++counters_.cells;
        const bool crosses =
            intersect_primitive<Any>(primitives, i, ray_, from, to, coordinate_bound_, nearest_, counters_);
        any_ |= Any && crosses;
    }

    void visit_instance(std::uint32_t i) {
        const std::uint32_t instance = i - std::uint32_t(surfaces_.cell_primitives.size());
        if constexpr (Any) {
            any_ = instances_->any_hit(instance, ray_, end(), counters_);
        } else {
            const FoundSurface found = instances_->closest_hit(instance, ray_, t_max_, end(), counters_);
            if (found.crossing.t < infinity) nearest_.offer(found.crossing, found.error, found.solid, i);
        }
    }

    const Surfaces& surfaces_;
    const Ray& ray_;
    Vec3 inverse_;
    double coordinate_bound_;  // of all terms of a point on the ray
    double begin_, t_max_;
    NearestCrossing nearest_;
    bool any_ = false;
    TraceCounters& counters_;
    const InstanceTracer* instances_;
};

}  // namespace deburr
