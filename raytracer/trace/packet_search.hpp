// Searches of several rays that are led together: through the boxes with one test for all, over planes and
// products of half-spaces with one instruction for several (packet_kernels.hpp), and one by one over what is left.
// Each finds what it finds alone (surface_search.hpp), to the bit.
#pragma once
#include <span>

#include "raytracer/simd/packet_kernels.hpp"
#include "raytracer/trace/surface_search.hpp"

namespace deburr {

template <bool Any>
class PacketSearch {
public:
    /// A search for at most RayPacket::size rays.
    PacketSearch(const Surfaces& surfaces, const RayBatch& rays, TraceCounters& counters,
                 const InstanceTracer* instances, double farthest = infinity)
        : surfaces_(surfaces),
          rays_(rays),
          counters_(counters),
          instances_(instances),
          lanes_((Lanes(1) << rays.size()) - 1) {
        for (std::size_t k = 0; k < RayPacket::size; ++k) {
            const std::size_t i = k < rays.size() ? k : 0;  // so that there are numbers everywhere
            for (int axis = 0; axis < 3; ++axis) {
                packet_.origin[axis][k] = rays.rays[i].origin[axis];
                packet_.direction[axis][k] = rays.rays[i].direction[axis];
            }
            packet_.t_max[k] = rays.t_max[i];
            packet_.end[k] = std::min(rays.t_max[i], rays.end[i]);
            if constexpr (!Any) nearest_[k] = NearestCrossing(packet_.end[k]);
        }
        is_far_ = packet_functions.prepare(packet_, surfaces.scale, farthest);
    }

    /// Whether a ray begins beyond `farthest`.
    bool is_far() const { return is_far_; }

    void search(const Bvh4& boxes) {
        visit_planes();
        if (boxes.empty() || lanes_ == 0) return;
        lanes_ = packet_functions.enter(boxes.box(), packet_, lanes_, entry_);
        if (lanes_ == 0) return;
        const Bvh4::Beam beam{entry_.min_point, entry_.max_point, entry_.min_direction, entry_.max_direction,
                              longest_distance()};
        boxes.visit_packet(beam, [&](std::uint32_t i) {
            if (!visit(i)) return infinity;
            return lanes_ == 0 ? -1.0 : longest_distance();
        });
    }

    /// The rays that cross anything.
    Lanes any_hit() const { return any_; }
    /// Nearest surface on ray k.
    FoundSurface surface(int k) const {
        return nearest_[k].surface(ray(k), rounding_of(packet_.coordinate_bound[k], nearest_[k].end()));
    }

private:
    const Ray& ray(int k) const { return rays_.rays[k]; }
    double longest_distance() const { return packet_functions.longest_distance(packet_, lanes_, entry_); }
    void visit_planes() {
        if (surfaces_.infinite_planes.size() == 0) return;
        PacketSpans spans;
        for (int k = 0; k < RayPacket::size; ++k) {
            spans.from[k] = std::size_t(k) < rays_.begin.size() ? rays_.begin[k] : 0;
            spans.to[k] = packet_.t_max[k];
        }
        for (std::size_t i = 0; i < surfaces_.infinite_planes.size(); ++i)
            intersect(surfaces_.infinite_planes, std::uint32_t(i), lanes_, spans);
    }

    // Whether anything was found.
    bool visit(std::uint32_t i) {
        if (i >= surfaces_.cell_primitives.size()) return visit_instance(i);
        PacketSpans spans;
        const Lanes in = packet_functions.spans_in_cell(surfaces_.cell_primitives[i].box, packet_, lanes_, spans);
        return in != 0 && intersect(surfaces_.cell_primitives, i, in, spans);
    }

    bool intersect(const CellPrimitives& primitives, std::uint32_t i, Lanes lanes, const PacketSpans& spans) {
        counters_.cells += std::uint64_t(__builtin_popcount(lanes));
        const CellPrimitive& p = primitives[i];
        if (!primitives.for_packets(i)) return intersect_one_by_one(primitives, i, lanes, spans);
        if constexpr (Any) {
            return found(primitives.any_crossings(p, packet_, lanes, spans, counters_));
        } else {
            PacketCrossings c;
            return found(primitives.crossings(p, packet_, lanes, spans, c, counters_), [&](int k) {
                nearest_[k].offer(primitives, i, {c.t[k], bool(c.entering >> k & 1), int(c.plane[k])});
            });
        }
    }

    bool intersect_one_by_one(const CellPrimitives& primitives, std::uint32_t i, Lanes lanes,
                              const PacketSpans& spans) {
        Lanes crossed = 0;
        for_each_lane(lanes, [&](int k) {
            NearestCrossing& nearest = nearest_[Any ? 0 : k];  // of no use where that there is one is all that is asked
            const bool crosses = intersect_primitive<Any>(primitives, i, ray(k), spans.from[k], spans.to[k],
                                                          packet_.coordinate_bound[k], nearest, counters_);
            crossed |= Lanes(crosses) << k;
        });
        return found(crossed);
    }

    bool visit_instance(std::uint32_t i) {
        const std::uint32_t instance = i - std::uint32_t(surfaces_.cell_primitives.size());
        PacketSpans spans;
        const Lanes in = packet_functions.spans_in_cell(surfaces_.instance_boxes[instance], packet_, lanes_, spans);
        if (in == 0) return false;
        Ray rays[RayPacket::size];
        double t_max[RayPacket::size], end[RayPacket::size];
        int lane[RayPacket::size];
        std::size_t count = 0;
        for_each_lane(in, [&](int k) {
            rays[count] = ray(k);
            t_max[count] = packet_.t_max[k];
            end[count] = packet_.end[k];
            lane[count++] = k;
        });
        const RayBatch batch{{rays, count}, {t_max, count}, {end, count}};
        Lanes crossed = 0;
        if constexpr (Any) {
            const Lanes any = instances_->any_hit_packet(instance, batch, counters_);
            for (std::size_t j = 0; j < count; ++j) crossed |= (any >> j & 1) << lane[j];
        } else {
            FoundSurface f[RayPacket::size];
            instances_->closest_hit_packet(instance, batch, f, counters_);
            for (std::size_t j = 0; j < count; ++j) {
                if (!(f[j].crossing.t < infinity)) continue;
                crossed |= Lanes(1) << lane[j];
                nearest_[lane[j]].offer(f[j].crossing, f[j].error, f[j].solid, i);
            }
        }
        return found(crossed);
    }

    template <class Offer>
    bool found(Lanes crossed, Offer offer) {
        if constexpr (Any) {
            any_ |= crossed;
            lanes_ &= ~crossed;
        } else {
            for_each_lane(crossed, [&](int k) {
                offer(k);
                packet_.end[k] = nearest_[k].end();
            });
        }
        return crossed != 0;
    }
    bool found(Lanes crossed) {
        return found(crossed, [](int) {});
    }

    const Surfaces& surfaces_;
    const RayBatch& rays_;
    TraceCounters& counters_;
    const InstanceTracer* instances_;
    Lanes lanes_, any_ = 0;  // that go on; that found something
    bool is_far_;
    RayPacket packet_;
    PacketEntry entry_;
    NearestCrossing nearest_[Any ? 1 : RayPacket::size];
};

}  // namespace deburr
