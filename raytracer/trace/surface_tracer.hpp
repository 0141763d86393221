// Traces rays through the BSPs of one prototype (instances.hpp).
//
// The BSPs' cells hold the surfaces; the cells that a ray meets are found by one BVH (bvh.hpp; or Embree's,
// embree_bvh.hpp) around what is in them, so that empty cells cost nothing. A BSP itself is traversed only
// outside of the BVH's box, where an unbounded solid goes on.
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

/// A BSP, and the numbers that its solids have in the scene or prototype around it.
struct NamedBsp {
    BspTree tree;
    std::vector<int> solids;  // by the BSP's numbers
};

class SurfaceTracer {
public:
    SurfaceTracer() = default;
    /// A tracer of one BSP, whose solids keep their numbers.
    SurfaceTracer(BspTree&& tree, Criterion criterion, Accel accel = Accel::bvh);
    /// A tracer of several BSPs, all but the first bounded, and of the instances in these boxes.
    SurfaceTracer(std::vector<NamedBsp> bsps, std::span<const Box> instance_boxes, Criterion criterion,
                  Accel accel = Accel::bvh);

    /// First crossing along the ray in [0, t_max]; none is needed beyond `end`. `instances` are asked by the
    /// number of their box.
    FoundSurface closest_hit(const Ray& ray, double t_max, TraceCounters& counters,
                             const InstanceTracer* instances = nullptr, double end = infinity) const {
        if (vicinity_.is_far(ray.origin)) [[unlikely]]
            return closest_hit_from_afar(ray, t_max, counters, instances, end);
        return closest_hit_nearby(ray, 0, t_max, counters, instances, end);
    }
    /// Whether there is one.
    bool any_hit(const Ray& ray, double t_max, TraceCounters& counters,
                 const InstanceTracer* instances = nullptr) const {
        if (vicinity_.is_far(ray.origin)) [[unlikely]]
            return any_hit_from_afar(ray, t_max, counters, instances);
        return any_hit_nearby(ray, 0, t_max, counters, instances);
    }
    /// Both queries for `lanes` of the rays, which begin at 0, with the same results to the bit.
    void closest_hit_packet(const RayPacket& rays, Lanes lanes, PacketSurfaces& found, TraceCounters& counters,
                            const InstanceTracer* instances = nullptr) const;
    Lanes any_hit_packet(const RayPacket& rays, Lanes lanes, TraceCounters& counters,
                         const InstanceTracer* instances = nullptr) const;

    /// Instances lie at `first`, so many bytes apart, as long as rays are traced.
    void instances_lie_at(const void* first, std::size_t stride) {
        boxes_.items_lie_at(std::uint32_t(surfaces_.cell_primitives.size()), first, stride);
    }

    const std::vector<BspTree>& trees() const { return trees_; }  // without their LocalSolids
    const Surfaces& surfaces() const { return surfaces_; }        // what these were, one tree's after the other's

private:
    void build_bvh(std::vector<NamedBsp> bsps, const std::vector<Box>& boxes, std::span<const Box> instance_boxes,
                   Accel accel);
    void keep(BspTree&& tree);
    template <bool Any>
    bool search(SurfaceSearch<Any>& search) const;
    // Queries in [begin, t_max], for rays that begin near the surfaces, or were moved there.
    FoundSurface closest_hit_nearby(const Ray& ray, double begin, double t_max, TraceCounters& counters,
                                    const InstanceTracer* instances, double end) const;
    bool any_hit_nearby(const Ray& ray, double begin, double t_max, TraceCounters& counters,
                        const InstanceTracer* instances) const;
    // Of rays that may come from far away.
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
    // Of primitives and then of instances; unbounded primitives as far as all else reaches. One of the two is there.
    Bvh8 boxes_;
    std::optional<EmbreeBvh> embree_;
    Box around_;  // all of these
    Vicinity vicinity_;
    bool bounded_ = true;  // nothing is outside
};

}  // namespace deburr
