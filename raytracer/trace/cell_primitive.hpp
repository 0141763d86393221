// Cell primitives: the surface of one solid within one cell, laid out for fast intersection.
//
// Most primitives are a plane or a product of half-spaces (bounds/convex_density.hpp), whose coefficients lie next to
// those of their neighbours. All others keep a LocalSolid; of these, packets handle surfaces of round parts and sums of
// products (bounds/product_sum.hpp).
#pragma once
#include <cstdint>
#include <vector>

#include "bounds/convex_density.hpp"
#include "raytracer/simd/packet_kernels.hpp"
#include "raytracer/trace/local_solid.hpp"
#include "raytracer/trace/ray_tracer.hpp"

namespace deburr {

/// A surface that rays are intersected with; it is valid only within `box`.
struct CellPrimitive {
    /// plane: one half-space; convex: a product of half-spaces, or one minus it; surface: a round part's; sum: a sum of
    /// products; general: anything else.
    enum class Kind : std::uint8_t { plane, convex, surface, sum, general };

    Box box;                               // the cell, cut to the solid's own box
    std::uint32_t index = 0;               // plane, convex: of the first factor in planes_; other kinds: in locals_
    std::int32_t solid = 0, material = 0;  // number in the prototype; index in the scene, −1: none
    std::uint8_t soft = 0, sharp = 0;      // convex: numbers of soft and sharp factors
    Kind kind = Kind::plane;
    bool complement = false;  // convex: the solid is {P ≤ ½} instead of {P > ½}
};
static_assert(sizeof(CellPrimitive) == 64);  // a cache line

/// A list of primitives, and the queries of rays against them. Distances are ray parameters; directions are unit
/// vectors.
class CellPrimitives {
public:
    CellPrimitives() = default;
    CellPrimitives(const Tolerances& tolerances, Criterion criterion)
        : tolerances_(tolerances), criterion_(criterion) {}

    /// Appends the primitive of a local solid, which must have a surface. `box` is its cell, `solid` its number in the
    /// prototype.
    void add(LocalSolid&& local, const Box& box, int solid);

    std::size_t size() const { return primitives_.size(); }
    const CellPrimitive& operator[](std::size_t i) const { return primitives_[i]; }
    /// Number of half-spaces in primitive i.
    std::size_t half_spaces(std::size_t i) const;

    /// Distance at which the ray's line meets the plane of primitive p; NaN or infinite if they are parallel.
    double plane_crossing(const CellPrimitive& p, const Vec3& origin, const Vec3& direction) const {
        const AlphaPlane& plane = planes_[p.index];
        return -(glm::dot(plane.slope, origin) + plane.base) / glm::dot(plane.slope, direction);
    }
    /// First crossing of a convex primitive in [t0, t1]; its t is infinity if there is none.
    ConvexCrossing convex_crossing(const CellPrimitive& p, const Vec3& origin, const Vec3& direction, double t0,
                                   double t1, TraceCounters& counters) const {
        return first_crossing(view(p), origin, direction, t0, t1, tolerances_.along(t0), counters.evaluations);
    }
    /// Whether the ray crosses a convex primitive in [t0, t1].
    bool crosses_convex(const CellPrimitive& p, const Vec3& origin, const Vec3& direction, double t0, double t1,
                        TraceCounters& counters) const {
        return any_crossing(view(p), origin, direction, t0, t1, tolerances_.along(t0), counters.evaluations);
    }
    /// Whether primitive i can be passed to the packet queries below.
    bool for_packets(std::size_t i) const {
        const CellPrimitive& p = primitives_[i];
        switch (p.kind) {
            case CellPrimitive::Kind::plane: return true;
            case CellPrimitive::Kind::convex: return p.soft <= max_packet_factors && p.box.finite();
            case CellPrimitive::Kind::surface:
            case CellPrimitive::Kind::sum: return p.box.finite();
            default: return false;
        }
    }
    /// First crossings of the rays in `lanes` with primitive p, each in its span. Returns the rays that have one;
    /// `found` is undefined for the others.
    Lanes crossings(const CellPrimitive& p, const RayPacket& rays, Lanes lanes, const PacketSpans& spans,
                    PacketCrossings& found, TraceCounters& counters) const;
    /// The rays among `lanes` that cross primitive p.
    Lanes any_crossings(const CellPrimitive& p, const RayPacket& rays, Lanes lanes, const PacketSpans& spans,
                        TraceCounters& counters) const;
    /// First crossing of a primitive that is neither plane nor convex; its t is infinity if there is none. With `any`,
    /// t and the normal only say that there is one.
    SurfaceCrossing general_crossing(const CellPrimitive& p, const Vec3& origin, const Vec3& direction, double t0,
                                     double t1, bool any, TraceCounters& counters) const;
    /// Unit normal, pointing out of the solid, where the ray crosses primitive p, which must be a plane or convex.
    Vec3 normal(const CellPrimitive& p, const ConvexCrossing& crossing, const Vec3& origin,
                const Vec3& direction) const;
    /// How far a crossing of p may be off its surface (a scene length), beyond the rounding of coordinates.
    double error(const CellPrimitive& p) const {
        const bool is_round =
            p.kind == CellPrimitive::Kind::surface || (p.kind == CellPrimitive::Kind::sum && !sum(p).rounds().empty());
        return is_round ? locals_[p.index].tolerances().of_round() : 0;
    }
    /// Unit normals, pointing out of the solid, where the rays in `lanes` cross p. Ray k crosses at distance end[k];
    /// `nearest` says whether it enters, and by which factor's plane.
    void normals(const CellPrimitive& p, const RayPacket& rays, const double* end, Lanes lanes,
                 const PacketNearest& nearest, double (*normal)[RayPacket::size]) const;

    /// A box around the part of primitive i that rays can cross in its cell or up to `margin` beyond it, itself
    /// enlarged by `margin`.
    Box surface_box(std::size_t i, double margin) const;

private:
    const ProductSum& sum(const CellPrimitive& p) const { return *locals_[p.index].sum(); }
    ConvexView view(const CellPrimitive& p) const { return {&planes_[p.index], p.soft, p.sharp, p.complement}; }

    std::vector<CellPrimitive> primitives_;
    std::vector<AlphaPlane> planes_;
    std::vector<LocalSolid> locals_;
    Tolerances tolerances_;
    Criterion criterion_ = Criterion::exact;
};

}  // namespace deburr
