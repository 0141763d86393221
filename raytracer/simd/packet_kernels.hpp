// Where the rays of a packet cross a primitive: what CellPrimitives and bounds/convex_density.hpp compute of one ray,
// of as many at a time as the processor's vectors hold. The instructions are chosen when the program starts (Highway).
//
// Each ray gets the same bits as alone, with any instructions: the same operations in the same order, none
// fused. So a picture depends neither on the machine nor on which rays travel together.
#pragma once
#include <vector>

#include "bounds/convex_density.hpp"
#include "bounds/product_sum.hpp"
#include "bounds/round_product.hpp"
#include "raytracer/simd/box_tree.hpp"
#include "raytracer/simd/instructions.hpp"
#include "raytracer/simd/ray_packet.hpp"

namespace deburr {

/// Intervals of a packet's rays in a box, and bounds of the points of entry and of the directions.
struct PacketEntry {
    alignas(64) double lo[RayPacket::size], hi[RayPacket::size];
    Vec3 min_point, max_point, min_direction, max_direction;
};

/// Intervals of a packet's rays in a cell, widened by its walls' rounding, in which its primitives are searched.
struct PacketSpans {
    alignas(64) double from[RayPacket::size], to[RayPacket::size];
};

struct PacketCrossings {
    alignas(64) double t[RayPacket::size];
    alignas(64) double plane[RayPacket::size];  // ConvexCrossing::plane
    Lanes entering = 0;
};

/// The nearest crossings of a packet's rays with primitives so far; where they are is RayTerms::end.
struct PacketNearest {
    alignas(64) double primitive[RayPacket::size];  // its number
    alignas(64) double plane[RayPacket::size];      // ConvexCrossing::plane
    Lanes found = 0, entering = 0;                  // those that have one; those of them that enter
    Lanes elsewhere = 0;                            // those whose nearest is kept elsewhere, with its normal
};

/// Soft factors beyond these are left to single rays.
constexpr int max_packet_factors = 8;

/// The kernels, compiled once for each set of instructions.
struct PacketFunctions {
    /// Lays out RayPacket::size rays, which begin at 0.
    void (*load)(RayPacket& packet, const Ray* rays, const double* t_max);

    /// Computes the rays' terms for a scene whose coordinates reach `scale`. Returns the rays that begin beyond
    /// `farthest` in a coordinate.
    Lanes (*prepare)(const RayPacket& rays, double scale, double farthest, RayTerms& terms);

    /// The rays as a map has them, with unit directions; distances become `rate` times as long, and `end` a little
    /// longer.
    void (*map)(const Affine& map, bool only_moved, const RayPacket& rays, const double* end, RayPacket& mapped,
                double* rate);

    /// The rays among `lanes` that meet the box before their end.
    Lanes (*enter)(const Box& box, const RayPacket& rays, const RayTerms& terms, Lanes lanes, PacketEntry& entry);

    /// How far the farthest of `lanes` goes on in the box, from where it enters.
    double (*longest_distance)(const RayTerms& terms, Lanes lanes, const PacketEntry& entry);

    /// The rays among `lanes` that are in the cell before their end.
    Lanes (*spans_in_cell)(const Box& cell, const RayPacket& rays, const RayTerms& terms, Lanes lanes,
                           PacketSpans& spans);

    /// The rays among `lanes` that cross the plane within their span, and where.
    Lanes (*plane_crossings)(const AlphaPlane& plane, const RayPacket& rays, Lanes lanes, const PacketSpans& spans,
                             PacketCrossings& found);

    /// Takes the crossings of `lanes` with a primitive that are nearer than the nearest so far. Returns those that are
    /// as near.
    Lanes (*keep_nearer)(RayTerms& terms, PacketNearest& nearest, const PacketCrossings& crossings, Lanes lanes,
                         std::uint32_t primitive);

    /// The unit normals of a product of half-spaces where `lanes` cross it, at their ends, against rays that enter it.
    void (*convex_normals)(const ConvexView& density, const RayPacket& rays, const double* end, Lanes lanes,
                           const PacketNearest& nearest, double (*normal)[RayPacket::size]);

    /// first_crossing() for each of `lanes`, whose spans must be finite, with t_tolerance = 8 ε (scale + |from|); those
    /// that have one.
    Lanes (*convex_crossings)(const ConvexView& density, const RayPacket& rays, Lanes lanes, const PacketSpans& spans,
                              double scale, PacketCrossings& found, std::uint64_t& evaluations);

    /// any_crossing() likewise.
    Lanes (*convex_any_crossings)(const ConvexView& density, const RayPacket& rays, Lanes lanes,
                                  const PacketSpans& spans, double scale, std::uint64_t& evaluations);

    /// First crossings of a round part's surface, and normals there.
    Lanes (*surface_crossings)(const RoundSurface& surface, const RayPacket& rays, Lanes lanes,
                               const PacketSpans& spans, PacketCrossings& found);
    void (*surface_normals)(const RoundSurface& surface, const RayPacket& rays, const double* end, Lanes lanes,
                            const PacketNearest& nearest, double (*normal)[RayPacket::size]);

    /// First crossings, any crossings and normals of a sum of products (ProductSumRay).
    Lanes (*sum_crossings)(const ProductSum& sum, const RayPacket& rays, Lanes lanes, const PacketSpans& spans,
                           double scale, PacketCrossings& found, RootCounters& counters);
    Lanes (*sum_any_crossings)(const ProductSum& sum, const RayPacket& rays, Lanes lanes, const PacketSpans& spans,
                               double scale, RootCounters& counters);
    void (*sum_normals)(const ProductSum& sum, const RayPacket& rays, const double* end, Lanes lanes,
                        const PacketNearest& nearest, double (*normal)[RayPacket::size]);

    /// Visits the items of a tree of boxes that a ray, or one of a beam's, may meet: the nearest first, but where boxes
    /// overlap.
    void (*walk_ray)(const BoxTree& tree, const BoxRay& ray, BoxVisitor visitor);
    void (*walk_beam)(const BoxTree& tree, const BoxBeam& beam, BoxVisitor visitor);
};

/// The kernels of every set of instructions that this machine has, the widest first.
std::vector<Instructions<PacketFunctions>> packet_instructions();

/// The kernels of the widest set of instructions that this machine has.
extern const PacketFunctions& packet_functions;

}  // namespace deburr
