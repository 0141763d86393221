// Traces the rays of a packet together: one test for all in the BVH, vector instructions for planes and products of
// half-spaces (packet_kernels.hpp), and single rays for other primitives. Each ray finds what it finds alone
// (surface_search.hpp), to the bit.
#pragma once
#include "raytracer/trace/packet_nearest_crossings.hpp"
#include "raytracer/trace/surface_search.hpp"

namespace deburr {

/// One search of a packet; with `Any` an any-hit query. Used once: construct, check is_far(), search().
template <bool Any>
class PacketSearch {
public:
    /// A search for the rays in `lanes`; origins with a coordinate beyond `farthest` are far. `found` is the
    /// PacketSurfaces of a closest-hit query, and absent with `Any`.
    template <class... Found>
    PacketSearch(const Surfaces& surfaces, const RayPacket& rays, Lanes lanes, TraceCounters& counters,
                 const InstanceTracer* instances, double farthest, Found&... found)
        : surfaces_(surfaces),
          counters_(counters),
          instances_(instances),
          lanes_(lanes),
          rays_(rays),
          nearest_(surfaces, found...) {
        is_far_ = (packet_functions.prepare(rays_, surfaces.scale, farthest, terms_) & lanes) != 0;
    }

    /// Whether the origin of a ray in `lanes` is far; search() must not be called then.
    bool is_far() const { return is_far_; }

    /// Finds the surfaces. `boxes` is the BVH over the primitives and instances.
    void search(const Bvh8& boxes) {
        visit_planes();
        visit_boxes(boxes);
        if constexpr (!Any) nearest_.finish(rays_, terms_);
    }

    /// With `Any`, the rays that cross a surface.
    Lanes any_hit() const { return any_; }

private:
    void visit_boxes(const Bvh8& boxes) {
        if (boxes.empty() || lanes_ == 0) return;
        lanes_ = packet_functions.enter(boxes.box(), rays_, terms_, lanes_, entry_);
        if (lanes_ == 0) return;
        const Bvh8::Beam beam{entry_.min_point, entry_.max_point, entry_.min_direction, entry_.max_direction,
                              longest_distance()};
        boxes.visit_packet(beam, [&](std::uint32_t i) {
            if (!visit(i)) return infinity;
            return lanes_ == 0 ? -1.0 : longest_distance();
        });
    }

    // Takes the place of the nearest crossings in an any-hit query.
    struct Nothing {
        explicit Nothing(const Surfaces&) {}
        Nothing of_ray(int, const Ray&, std::uint32_t, const RayTerms&) const { return *this; }
    };
    using Nearest = std::conditional_t<Any, Nothing, PacketNearestCrossings>;

    double longest_distance() const { return packet_functions.longest_distance(terms_, lanes_, entry_); }
    void visit_planes() {
        if (surfaces_.infinite_planes.size() == 0) return;
        PacketSpans spans;
        std::copy_n(rays_.begin, RayPacket::size, spans.from);
        std::copy_n(rays_.t_max, RayPacket::size, spans.to);
        for (std::size_t i = 0; i < surfaces_.infinite_planes.size(); ++i)
            intersect(surfaces_.infinite_planes, std::uint32_t(i), PacketNearestCrossings::first_infinite_plane, lanes_,
                      spans);
    }

    // Visits item i of the BVH; true if a ray found something.
    bool visit(std::uint32_t i) {
        if (i >= surfaces_.cell_primitives.size()) return visit_instance(i);
        PacketSpans spans;
        const Lanes in = packet_functions.spans_in_cell(surfaces_.cell_primitives[i].box, rays_, terms_, lanes_, spans);
        return in != 0 && intersect(surfaces_.cell_primitives, i, 0, in, spans);
    }

    // Primitive i of the list has the number first + i.
    bool intersect(const CellPrimitives& primitives, std::uint32_t i, std::uint32_t first, Lanes lanes,
                   const PacketSpans& spans) {
        counters_.cells += count(lanes);
        const CellPrimitive& p = primitives[i];
        if (!primitives.for_packets(i)) return intersect_one_by_one(primitives, i, first, lanes, spans);
        if constexpr (Any) {
            return found(primitives.any_crossings(p, rays_, lanes, spans, counters_));
        } else {
            PacketCrossings c;
            const Lanes crossed = primitives.crossings(p, rays_, lanes, spans, c, counters_);
            if (crossed != 0) nearest_.offer(first + i, c, crossed, terms_);
            return crossed != 0;
        }
    }

    bool intersect_one_by_one(const CellPrimitives& primitives, std::uint32_t i, std::uint32_t first, Lanes lanes,
                              const PacketSpans& spans) {
        Lanes crossed = 0;
        for_each_lane(lanes, [&](int k) {
            const Ray ray = rays_.ray(k);
            const double bound = terms_.coordinate_bound[k];
            auto nearest = nearest_.of_ray(k, ray, first, terms_);
            const bool crosses =
                intersect_primitive<Any>(primitives, i, ray, spans.from[k], spans.to[k], bound, nearest, counters_);
            crossed |= Lanes(crosses) << k;
        });
        return found(crossed);
    }

    bool visit_instance(std::uint32_t i) {
        const std::uint32_t instance = i - std::uint32_t(surfaces_.cell_primitives.size());
        PacketSpans spans;
        const Lanes in =
            packet_functions.spans_in_cell(surfaces_.instance_boxes[instance], rays_, terms_, lanes_, spans);
        if (in == 0) return false;
        if constexpr (Any) {
            return found(instances_->any_hit_packet(instance, rays_, in, counters_));
        } else {
            PacketSurfaces surfaces;
            instances_->closest_hit_packet(instance, rays_, terms_.end, in, surfaces, counters_);
            nearest_.offer(surfaces, i, terms_);
            return surfaces.found != 0;
        }
    }

    bool found(Lanes crossed) {
        if constexpr (Any) {
            any_ |= crossed;
            lanes_ &= ~crossed;
        }
        return crossed != 0;
    }

    const Surfaces& surfaces_;
    TraceCounters& counters_;
    const InstanceTracer* instances_;
    Lanes lanes_, any_ = 0;  // rays still searching; rays that found a surface (with `Any`)
    bool is_far_;
    const RayPacket& rays_;
    RayTerms terms_;
    PacketEntry entry_;
    Nearest nearest_;
};

}  // namespace deburr
