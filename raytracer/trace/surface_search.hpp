// The search for a ray's first crossing among the surfaces of one space, whatever leads it to them: a tree
// of boxes, a walk through a BSP, or another's hierarchy.
//
// What is found does not depend on the order in which surfaces are looked at, nor on whether one that the
// ray does not cross is looked at: what a ray crosses of one is a function of the two alone, and which of
// several crossings is taken is settled (nearest_crossing.hpp).
#pragma once
#include <span>

#include "raytracer/accel/bvh.hpp"
#include "raytracer/trace/nearest_crossing.hpp"

namespace deburr {

/// Rays that run close to each other: each in [begin, t_max]; what lies beyond `end` need not be found.
struct SeveralRays {
    std::span<const Ray> rays;
    std::span<const double> t_max, end;
    std::span<const double> begin = {};  // empty: 0

    std::size_t size() const { return rays.size(); }
};

/// What is in a space besides: found by its box, asked for by its number.
class Others {
public:
    /// First crossing along the ray in [0, t_max]; none is needed beyond `end`.
    virtual FoundSurface find(std::uint32_t other, const Ray& ray, double t_max, double end,
                              TraceCounters& counters) const = 0;
    /// Whether there is one.
    virtual bool any(std::uint32_t other, const Ray& ray, double t_max, TraceCounters& counters) const = 0;
    /// The same for at most RayPacket::size rays, to the bit.
    virtual void find_together(std::uint32_t other, const SeveralRays& rays, FoundSurface* found,
                               TraceCounters& counters) const {
        for (std::size_t k = 0; k < rays.size(); ++k)
            found[k] = find(other, rays.rays[k], rays.t_max[k], rays.end[k], counters);
    }
    virtual Lanes any_together(std::uint32_t other, const SeveralRays& rays, TraceCounters& counters) const {
        Lanes found = 0;
        for (std::size_t k = 0; k < rays.size(); ++k)
            found |= Lanes(any(other, rays.rays[k], rays.t_max[k], counters)) << k;
        return found;
    }

protected:
    ~Others() = default;
};

/// The surfaces of one space. Pieces and then others are numbered as one.
struct Surfaces {
    double scale = 1;  // coordinates reach so far
    Pieces pieces;
    Pieces planes;            // whole solids
    std::vector<Box> others;  // around them, with more to spare than rounding makes of a ray
};

/// What a distance along a ray is rounded by, where coordinates that are added reach so far.
inline double rounding_of(double reach, double t) { return 4 * epsilon * (reach + std::abs(t)); }

/// Whether the ray crosses piece i in [from, to]. Unless that is all that is asked (`Any`), the first crossing is
/// offered to `nearest`.
template <bool Any>
[[gnu::always_inline]] inline bool look_at_piece(const Pieces& pieces, std::uint32_t i, const Ray& ray, double from,
                                                 double to, double reach, NearestCrossing& nearest,
                                                 TraceCounters& counters) {
    const Piece& p = pieces[i];
    if (p.kind == Piece::Kind::plane) {
        const double t = pieces.plane_crossing(p, ray.origin, ray.direction);
        if (!(t >= from && t <= to && t < infinity)) return false;
        ++counters.flat_hits;
        if constexpr (!Any) nearest.offer(pieces, i, {t});
        return true;
    }
    if (p.kind == Piece::Kind::convex) {
        if constexpr (Any) return pieces.crosses_convex(p, ray.origin, ray.direction, from, to, counters);
        const ConvexCrossing c = pieces.convex_crossing(p, ray.origin, ray.direction, from, to, counters);
        if (!(c.t < infinity)) return false;
        nearest.offer(pieces, i, c);
        return true;
    }
    const SurfaceCrossing c = pieces.general_crossing(p, ray.origin, ray.direction, from, to, Any, counters);
    if (!(c.t < infinity)) return false;
    if constexpr (!Any) nearest.offer(c, rounding_of(reach, c.t) + c.error, p.solid, i);
    return true;
}

/// `Any`: that there is a crossing in [begin, t_max] is all that is asked.
template <bool Any>
class SurfaceSearch {
public:
    /// In [begin, t_max]; what lies beyond `end` need not be found.
    SurfaceSearch(const Surfaces& surfaces, const Ray& ray, double t_max, double end, TraceCounters& counters,
                  const Others* others, double begin = 0)
        : surfaces_(surfaces),
          ray_(ray),
          inverse_(reciprocal(ray.direction)),
          reach_(surfaces.scale + largest(ray.origin)),
          begin_(begin),
          t_max_(t_max),
          nearest_(std::min(t_max, end)),
          counters_(counters),
          others_(others) {}

    const Ray& ray() const { return ray_; }
    const Vec3& inverse() const { return inverse_; }
    bool found() const { return nearest_.found() || any_; }
    double begin() const { return begin_; }
    /// Nothing counts beyond.
    double end() const { return nearest_.end(); }
    /// Nothing more needs to be looked at.
    bool enough() const { return any_; }
    /// A distance along the ray is rounded by this much.
    double rounding(double t) const { return rounding_of(reach_, t); }

    void look_at_planes() {
        for (std::size_t i = 0; i < surfaces_.planes.size(); ++i)
            look(surfaces_.planes, std::uint32_t(i), begin_, t_max_);
    }

    void look_at(std::uint32_t i) {
        if (i < surfaces_.pieces.size())
            look_in_cell(i);
        else
            look_at_other(i);
    }

    /// What was found.
    FoundSurface surface() const { return nearest_.surface(ray_, rounding(nearest_.end())); }

private:
    void look_in_cell(std::uint32_t i) {
        // As far as t_max, not end(): what is found may depend on both ends of the stretch, by rounding.
        const BoxSpan span = span_in(surfaces_.pieces[i].box, ray_.origin, inverse_, begin_, t_max_);
        // Cells overlap by what their walls are rounded by: a surface in a wall belongs to both.
        const double pad = rounding(std::min(span.lo, span.hi));
        const double from = std::max(begin_, span.lo - pad), to = std::min(t_max_, span.hi + pad);
        if (from <= to && from <= end()) look(surfaces_.pieces, i, from, to);
    }

    [[gnu::always_inline]] void look(const Pieces& pieces, std::uint32_t i, double from, double to) {
        ++counters_.cells;
        const bool crosses = look_at_piece<Any>(pieces, i, ray_, from, to, reach_, nearest_, counters_);
        any_ |= Any && crosses;
    }

    void look_at_other(std::uint32_t i) {
        const std::uint32_t other = i - std::uint32_t(surfaces_.pieces.size());
        if constexpr (Any) {
            any_ = others_->any(other, ray_, end(), counters_);
        } else {
            const FoundSurface found = others_->find(other, ray_, t_max_, end(), counters_);
            if (found.crossing.t < infinity) nearest_.offer(found.crossing, found.error, found.solid, i);
        }
    }

    const Surfaces& surfaces_;
    const Ray& ray_;
    Vec3 inverse_;
    double reach_;  // of coordinates that are added
    double begin_, t_max_;
    NearestCrossing nearest_;
    bool any_ = false;
    TraceCounters& counters_;
    const Others* others_;
};

}  // namespace deburr
