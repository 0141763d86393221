// Rays through BSPs of one space.
//
// The BSPs' cells say what there is; which of them a ray meets is found by one tree of boxes
// (bvh.hpp; or Embree's, embree_bvh.hpp) around what is in them, so that empty cells cost nothing. Only
// outside of that tree, where an unbounded solid goes on, is a BSP itself traversed.
#pragma once
#include <optional>

#include "raytracer/accel/bvh.hpp"
#include "raytracer/accel/embree_bvh.hpp"
#include "raytracer/trace/bsp_tree.hpp"
#include "raytracer/trace/far_ray.hpp"
#include "raytracer/trace/surface_search.hpp"
#include "raytracer/trace/trace_settings.hpp"

namespace deburr {

/// A BSP, and how the space around calls its solids.
struct NamedBsp {
    BspTree tree;
    std::vector<int> solids;  // by the BSP's numbers
};

class BspTracer {
public:
    BspTracer() = default;
    /// Of one BSP, with its numbers.
    BspTracer(BspTree&& tree, Criterion criterion, Accel accel = Accel::bsp);
    /// Of several, of which but the first must be bounded, and of others' boxes.
    BspTracer(std::vector<NamedBsp> bsps, const std::vector<Box>& others, Criterion criterion,
              Accel accel = Accel::bsp);

    /// First crossing along the ray in [0, t_max]; none is needed beyond `end`. `others` are asked by the
    /// number of their box.
    FoundSurface find(const Ray& ray, double t_max, TraceCounters& counters, const Others* others = nullptr,
                      double end = infinity) const {
        if (vicinity_.is_far(ray.origin)) [[unlikely]]
            return find_from_afar(ray, t_max, counters, others, end);
        return find_nearby(ray, 0, t_max, counters, others, end);
    }
    /// Whether there is one.
    bool any(const Ray& ray, double t_max, TraceCounters& counters, const Others* others = nullptr) const {
        if (vicinity_.is_far(ray.origin)) [[unlikely]]
            return any_from_afar(ray, t_max, counters, others);
        return any_nearby(ray, 0, t_max, counters, others);
    }
    /// The same for at most RayPacket::size rays, to the bit.
    void find(const SeveralRays& rays, FoundSurface* found, TraceCounters& counters,
              const Others* others = nullptr) const;
    Lanes any(const SeveralRays& rays, TraceCounters& counters, const Others* others = nullptr) const;

    /// Others lie at `first`, so many bytes apart, as long as rays are traced.
    void others_lie_at(const void* first, std::size_t apart) {
        boxes_.items_lie_at(std::uint32_t(surfaces_.pieces.size()), first, apart);
    }

    const std::vector<BspTree>& trees() const { return trees_; }  // without their LocalSolids
    const Surfaces& surfaces() const { return surfaces_; }        // what these were, one tree's after the other's

private:
    template <bool Any>
    bool search(SurfaceSearch<Any>& search) const;
    // In [begin, t_max]; of rays that are near the space, or moved there.
    FoundSurface find_nearby(const Ray& ray, double begin, double t_max, TraceCounters& counters, const Others* others,
                             double end) const;
    bool any_nearby(const Ray& ray, double begin, double t_max, TraceCounters& counters, const Others* others) const;
    // Of rays that may come from far away.
    FoundSurface find_from_afar(const Ray& ray, double t_max, TraceCounters& counters, const Others* others,
                                double end) const;
    bool any_from_afar(const Ray& ray, double t_max, TraceCounters& counters, const Others* others) const;
    void find_from_afar(const SeveralRays& rays, FoundSurface* found, TraceCounters& counters,
                        const Others* others) const;
    Lanes any_from_afar(const SeveralRays& rays, TraceCounters& counters, const Others* others) const;
    template <bool Any>
    void walk(SurfaceSearch<Any>& search, double t0, double t1) const;
    bool leads_together(std::size_t rays) const;
    double farthest(const SeveralRays& rays) const;
    bool has_unbounded() const { return !bounded_ || surfaces_.planes.size() > 0; }

    std::vector<BspTree> trees_;
    Surfaces surfaces_;
    // Of pieces and then of others; unbounded pieces as far as all else reaches. One of the two is there.
    BoxTree boxes_;
    std::optional<EmbreeBoxes> embree_;
    Box around_;  // all of these
    Vicinity vicinity_;
    bool bounded_ = true;  // nothing is outside
};

}  // namespace deburr
