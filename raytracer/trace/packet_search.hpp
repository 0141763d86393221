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
    /// Of at most RayPacket::size rays.
    PacketSearch(const Surfaces& surfaces, const SeveralRays& rays, TraceCounters& counters, const Others* others,
                 double farthest = infinity)
        : surfaces_(surfaces),
          rays_(rays),
          counters_(counters),
          others_(others),
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

    void search(const BoxTree& boxes) {
        look_at_planes();
        if (boxes.empty() || lanes_ == 0) return;
        lanes_ = packet_functions.enter(boxes.box(), packet_, lanes_, entry_);
        if (lanes_ == 0) return;
        const BoxTree::Beam beam{entry_.least_point, entry_.most_point, entry_.least_direction, entry_.most_direction,
                                 longest_way()};
        boxes.visit_together(beam, [&](std::uint32_t i) {
            if (!look_at(i)) return infinity;
            return lanes_ == 0 ? -1.0 : longest_way();
        });
    }

    /// Those that cross anything.
    Lanes any() const { return any_; }
    /// What ray k found.
    FoundSurface surface(int k) const {
        return nearest_[k].surface(ray(k), rounding_of(packet_.reach[k], nearest_[k].end()));
    }

private:
    const Ray& ray(int k) const { return rays_.rays[std::size_t(k)]; }
    double longest_way() const { return packet_functions.longest_way(packet_, lanes_, entry_); }
    void look_at_planes() {
        if (surfaces_.planes.size() == 0) return;
        PacketSpans spans;
        for (int k = 0; k < RayPacket::size; ++k) {
            spans.from[k] = std::size_t(k) < rays_.begin.size() ? rays_.begin[std::size_t(k)] : 0;
            spans.to[k] = packet_.t_max[k];
        }
        for (std::size_t i = 0; i < surfaces_.planes.size(); ++i)
            look(surfaces_.planes, std::uint32_t(i), lanes_, spans);
    }

    // Whether anything was found.
    bool look_at(std::uint32_t i) {
        if (i >= surfaces_.pieces.size()) return look_at_other(i);
        PacketSpans spans;
        const Lanes in = packet_functions.spans_in_cell(surfaces_.pieces[i].box, packet_, lanes_, spans);
        return in != 0 && look(surfaces_.pieces, i, in, spans);
    }

    bool look(const Pieces& pieces, std::uint32_t i, Lanes lanes, const PacketSpans& spans) {
        counters_.cells += std::uint64_t(__builtin_popcount(lanes));
        const Piece& p = pieces[i];
        if (!pieces.for_packets(i)) return look_one_by_one(pieces, i, lanes, spans);
        if constexpr (Any) {
            return found(pieces.occlusions(p, packet_, lanes, spans, counters_));
        } else {
            PacketCrossings c;
            return found(pieces.crossings(p, packet_, lanes, spans, c, counters_), [&](int k) {
                nearest_[k].offer(pieces, i, {c.t[k], bool(c.entering >> k & 1), int(c.plane[k])});
            });
        }
    }

    bool look_one_by_one(const Pieces& pieces, std::uint32_t i, Lanes lanes, const PacketSpans& spans) {
        Lanes crossed = 0;
        for_each_lane(lanes, [&](int k) {
            NearestCrossing& nearest = nearest_[Any ? 0 : k];  // of no use where that there is one is all that is asked
            const bool crosses =
                look_at_piece<Any>(pieces, i, ray(k), spans.from[k], spans.to[k], packet_.reach[k], nearest, counters_);
            crossed |= Lanes(crosses) << k;
        });
        return found(crossed);
    }

    bool look_at_other(std::uint32_t i) {
        const std::uint32_t other = i - std::uint32_t(surfaces_.pieces.size());
        PacketSpans spans;
        const Lanes in = packet_functions.spans_in_cell(surfaces_.others[other], packet_, lanes_, spans);
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
        const SeveralRays several{{rays, count}, {t_max, count}, {end, count}};
        Lanes crossed = 0;
        if constexpr (Any) {
            const Lanes any = others_->any_together(other, several, counters_);
            for (std::size_t j = 0; j < count; ++j) crossed |= (any >> j & 1) << lane[j];
        } else {
            FoundSurface f[RayPacket::size];
            others_->find_together(other, several, f, counters_);
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
    const SeveralRays& rays_;
    TraceCounters& counters_;
    const Others* others_;
    Lanes lanes_, any_ = 0;  // that go on; that found something
    bool is_far_;
    RayPacket packet_;
    PacketEntry entry_;
    NearestCrossing nearest_[Any ? 1 : RayPacket::size];
};

}  // namespace deburr
