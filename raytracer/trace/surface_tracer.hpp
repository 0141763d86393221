// Traces rays against the surfaces of one prototype (instances.hpp).
//
// The surfaces are in the cells of BSPs. A single BVH (bvh.hpp, or Embree's in embree_bvh.hpp) over the cells' content
// finds the cells that a ray meets, so that empty cells cost nothing. A BSP itself is traversed only outside of the
// BVH's box, where an unbounded solid continues.
#pragma once
#include <optional>
#include <span>

#include "raytracer/accel/bvh.hpp"
#include "raytracer/accel/embree_bvh.hpp"
#include "raytracer/trace/bsp_tree.hpp"
#include "raytracer/trace/far_ray.hpp"
#include "raytracer/trace/surface_search.hpp"
#include "raytracer/trace/trace_settings.hpp"

namespace deburr {

/// A BSP, and the numbers of its solids in the scene or prototype around it.
struct NamedBsp {
    BspTree tree;
    std::vector<int> solids;  // by the number in the BSP
};

/// All surfaces of one prototype with their acceleration structure. Queries are thread-safe.
class SurfaceTracer {
public:
    SurfaceTracer() = default;
    /// A tracer of one BSP, whose solids keep their numbers.
    SurfaceTracer(BspTree&& tree, Criterion criterion, Accel accel = Accel::bvh);
    /// A tracer of several BSPs, of which only the first may hold unbounded solids, and of the instances in these
    /// boxes.
    SurfaceTracer(std::vector<NamedBsp> bsps, std::span<const Box> instance_boxes, Criterion criterion,
                  Accel accel = Accel::bvh);

    /// First crossing along the ray in [0, t_max]; one beyond `end` need not be found. `instances` traces the instances
    /// by the index of their box; it may be null if there are none.
    FoundSurface closest_hit(const Ray& ray, double t_max, TraceCounters& counters,
                             const InstanceTracer* instances = nullptr, double end = infinity) const {
        if (vicinity_.is_far(ray.origin)) [[unlikely]]
            return closest_hit_from_afar(ray, t_max, counters, instances, end);
        return closest_hit_nearby(ray, 0, t_max, counters, instances, end);
    }
    /// Whether the ray crosses a surface in [0, t_max].
    bool any_hit(const Ray& ray, double t_max, TraceCounters& counters,
                 const InstanceTracer* instances = nullptr) const {
        if (vicinity_.is_far(ray.origin)) [[unlikely]]
            return any_hit_from_afar(ray, t_max, counters, instances);
        return any_hit_nearby(ray, 0, t_max, counters, instances);
    }
    /// Both queries for the rays in `lanes`, which begin at 0, with the same results to the bit.
    void closest_hit_packet(const RayPacket& rays, Lanes lanes, PacketSurfaces& found, TraceCounters& counters,
                            const InstanceTracer* instances = nullptr) const;
    Lanes any_hit_packet(const RayPacket& rays, Lanes lanes, TraceCounters& counters,
                         const InstanceTracer* instances = nullptr) const;

    /// Tells where the caller keeps its array of instances (address and stride in bytes), for prefetching. It must stay
    /// valid while rays are traced.
    void instances_lie_at(const void* first, std::size_t stride) {
        boxes_.items_lie_at(std::uint32_t(surfaces_.cell_primitives.size()), first, stride);
    }

    const std::vector<BspTree>& trees() const { return trees_; }  // without their local solids
    const Surfaces& surfaces() const { return surfaces_; }        // made of all trees' local solids, in their order

private:
    void build_bvh(std::vector<NamedBsp> bsps, const std::vector<Box>& boxes, std::span<const Box> instance_boxes,
                   Accel accel);
    void keep(BspTree&& tree);
    template <bool Any>
    bool search(SurfaceSearch<Any>& search) const;
    // Queries in [begin, t_max] for rays whose origin is near, or was moved there.
    FoundSurface closest_hit_nearby(const Ray& ray, double begin, double t_max, TraceCounters& counters,
                                    const InstanceTracer* instances, double end) const;
    bool any_hit_nearby(const Ray& ray, double begin, double t_max, TraceCounters& counters,
                        const InstanceTracer* instances) const;
    // Queries for rays whose origin may be far.
    FoundSurface closest_hit_from_afar(const Ray& ray, double t_max, TraceCounters& counters,
                                       const InstanceTracer* instances, double end) const;
    bool any_hit_from_afar(const Ray& ray, double t_max, TraceCounters& counters,
                           const InstanceTracer* instances) const;
    void closest_hit_from_afar(const RayPacket& rays, Lanes lanes, PacketSurfaces& found, TraceCounters& counters,
                               const InstanceTracer* instances) const;
    Lanes any_hit_from_afar(const RayPacket& rays, Lanes lanes, TraceCounters& counters,
                            const InstanceTracer* instances) const;
    template <bool Any>
    void walk(SurfaceSearch<Any>& search, double t0, double t1) const;
    bool use_packet(Lanes lanes) const;
    bool has_unbounded() const { return !bounded_ || surfaces_.infinite_planes.size() > 0; }

    std::vector<BspTree> trees_;
    Surfaces surfaces_;
    // The BVH over cell primitives, then instances; unbounded primitives are cut to the box of all others. Either
    // boxes_ or embree_ is used.
    Bvh8 boxes_;
    std::optional<EmbreeBvh> embree_;
    Box around_;  // box of all items in the BVH
    Vicinity vicinity_;
    bool bounded_ = true;  // whether all cell primitives are bounded
};

}  // namespace deburr
