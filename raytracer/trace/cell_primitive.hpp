// A primitive of one solid's surface: what may be crossed of it in one cell, laid out to be crossed fast.
//
// Most primitives are a plane or a product of half-spaces (bounds/convex_density.hpp), whose numbers lie
// side by side with those of their neighbours. What is neither is a LocalSolid; packets know it if it is the
// surface of a round part or a sum of products (bounds/product_sum.hpp), and nothing else.
#pragma once
#include <cstdint>
#include <vector>

#include "bounds/convex_density.hpp"
#include "raytracer/simd/packet_kernels.hpp"
#include "raytracer/trace/local_solid.hpp"
#include "raytracer/trace/ray_tracer.hpp"

namespace deburr {

struct CellPrimitive {
    enum class Kind : std::uint8_t { plane, convex, surface, sum, general };

    Box box;                  // the cell; beyond it the primitive is not valid
    std::uint32_t index = 0;  // in CellPrimitives::planes; others: in CellPrimitives::locals
    std::int32_t solid = 0, material = 0;
    std::uint8_t soft = 0, sharp = 0;  // factors
    Kind kind = Kind::plane;
    bool complement = false;
};
static_assert(sizeof(CellPrimitive) == 64);  // a cache line

class CellPrimitives {
public:
    CellPrimitives() = default;
    CellPrimitives(const Tolerances& tolerances, Criterion criterion)
        : tolerances_(tolerances), criterion_(criterion) {}

    /// `box`: the cell; `solid`: the number of its solid here.
    void add(LocalSolid&& local, const Box& box, int solid);

    std::size_t size() const { return primitives_.size(); }
    const CellPrimitive& operator[](std::size_t i) const { return primitives_[i]; }
    std::size_t half_spaces(std::size_t i) const;

    /// Distance at which a ray's line meets the plane that primitive p is; NaN or infinite if they are parallel.
    double plane_crossing(const CellPrimitive& p, const Vec3& origin, const Vec3& direction) const {
        const AlphaPlane& plane = planes_[p.index];
        return -(glm::dot(plane.slope, origin) + plane.base) / glm::dot(plane.slope, direction);
    }
    /// First crossing of a convex primitive in [t0, t1]; whether there is one.
    ConvexCrossing convex_crossing(const CellPrimitive& p, const Vec3& origin, const Vec3& direction, double t0,
                                   double t1, TraceCounters& counters) const {
        return first_crossing(view(p), origin, direction, t0, t1, tolerances_.along(t0), counters.evaluations);
    }
    bool crosses_convex(const CellPrimitive& p, const Vec3& origin, const Vec3& direction, double t0, double t1,
                        TraceCounters& counters) const {
        return any_crossing(view(p), origin, direction, t0, t1, tolerances_.along(t0), counters.evaluations);
    }
    /// Whether packets may ask for primitive i.
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
    /// First crossings of rays of a packet with such a primitive, in their spans; those that have one.
    Lanes crossings(const CellPrimitive& p, const RayPacket& rays, Lanes lanes, const PacketSpans& spans,
                    PacketCrossings& found, TraceCounters& counters) const;
    /// The rays among `lanes` that cross primitive p.
    Lanes any_crossings(const CellPrimitive& p, const RayPacket& rays, Lanes lanes, const PacketSpans& spans,
                        TraceCounters& counters) const;
    /// First crossing of one that is neither plane nor convex; `any`: that there is one will do, and its t means
    /// nothing.
    SurfaceCrossing general_crossing(const CellPrimitive& p, const Vec3& origin, const Vec3& direction, double t0,
                                     double t1, bool any, TraceCounters& counters) const;
    /// Unit normal, out of the solid, of primitive p: a plane, or convex.
    Vec3 normal(const CellPrimitive& p, const ConvexCrossing& crossing, const Vec3& origin,
                const Vec3& direction) const;
    /// Error of p's place, besides what coordinates are rounded by.
    double error(const CellPrimitive& p) const {
        const bool is_round =
            p.kind == CellPrimitive::Kind::surface || (p.kind == CellPrimitive::Kind::sum && !sum(p).rounds().empty());
        return is_round ? locals_[p.index].tolerances().of_round() : 0;
    }
    /// normal() for `lanes`, which cross p at their ends.
    void normals(const CellPrimitive& p, const RayPacket& rays, const double* end, Lanes lanes,
                 const PacketNearest& nearest, double (*normal)[RayPacket::size]) const;

    /// A box around what can be crossed of primitive i, in its cell or this much beyond, with as much to spare.
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
