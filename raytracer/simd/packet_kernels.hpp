// Vector kernels for packets: the BVH traversal, and where rays cross primitives, for as many rays at a time as a
// register holds. The scalar counterparts are in CellPrimitives and bounds/convex_density.hpp. The instruction set is
// chosen when the program starts (Highway).
//
// A ray gets the same bits as alone, with any instruction set: the same operations in the same order, none of them
// fused. So a picture depends neither on the machine nor on which rays share a packet.
#pragma once
#include <vector>

#include "bounds/convex_density.hpp"
#include "bounds/product_sum.hpp"
#include "bounds/round_product.hpp"
#include "raytracer/simd/box_tree.hpp"
#include "raytracer/simd/instructions.hpp"
#include "raytracer/simd/ray_packet.hpp"

namespace deburr {

/// Intervals of a packet's rays in a box, and bounds of their points of entry and of their directions.
struct PacketEntry {
    alignas(64) double lo[RayPacket::size], hi[RayPacket::size];
    Vec3 min_point, max_point, min_direction, max_direction;
};

/// Intervals of a packet's rays in a cell, widened by the rounding of its walls, in which its primitives are
/// intersected.
struct PacketSpans {
    alignas(64) double from[RayPacket::size], to[RayPacket::size];
};

/// Crossings of a packet's rays with one primitive; which rays have one is returned beside it.
struct PacketCrossings {
    alignas(64) double t[RayPacket::size];
    alignas(64) double plane[RayPacket::size];  // index of the factor, ConvexCrossing::plane
    Lanes entering = 0;                         // rays that enter the solid
};

/// The nearest crossings of a packet's rays so far; their distances are in RayTerms::end.
struct PacketNearest {
    alignas(64) double primitive[RayPacket::size];  // the primitive's number
    alignas(64) double plane[RayPacket::size];      // index of the factor, ConvexCrossing::plane
    Lanes found = 0, entering = 0;                  // rays that have a crossing; those of them that enter
    Lanes elsewhere = 0;                            // rays whose surface, with its normal, the caller keeps elsewhere
};

/// Primitives with more soft factors than this are intersected by single rays.
constexpr int max_packet_factors = 8;

/// The kernels, compiled once for each instruction set. `lanes` are the rays that a query is about; results for others
/// are undefined.
struct PacketFunctions {
    /// Fills a packet from RayPacket::size rays; they begin at 0, and their `end` is t_max.
    void (*load)(RayPacket& packet, const Ray* rays, const double* t_max);

    /// Computes the rays' terms for coordinates up to `scale`. Returns the rays whose origin has a coordinate beyond
    /// `farthest`.
    Lanes (*prepare)(const RayPacket& rays, double scale, double farthest, RayTerms& terms);

    /// Transforms the rays by the map and normalizes their directions: distances along ray k become rate[k] times as
    /// long. The new `end` is at least `end` in new distances, rounded up. With `only_moved`, the map is a translation.
    void (*map)(const Affine& map, bool only_moved, const RayPacket& rays, const double* end, RayPacket& mapped,
                double* rate);

    /// The rays among `lanes` that meet the box before their end, their intervals in it, and the bounds of these.
    Lanes (*enter)(const Box& box, const RayPacket& rays, const RayTerms& terms, Lanes lanes, PacketEntry& entry);

    /// The longest distance that any ray of `lanes` goes on in the box from its entry, up to its end.
    double (*longest_distance)(const RayTerms& terms, Lanes lanes, const PacketEntry& entry);

    /// The rays among `lanes` that are in the cell before their end, and their spans there.
    Lanes (*spans_in_cell)(const Box& cell, const RayPacket& rays, const RayTerms& terms, Lanes lanes,
                           PacketSpans& spans);

    /// The rays among `lanes` that cross the plane within their span, and where.
    Lanes (*plane_crossings)(const AlphaPlane& plane, const RayPacket& rays, Lanes lanes, const PacketSpans& spans,
                             PacketCrossings& found);

    /// Records the crossings of `lanes` with a primitive that are nearer than the nearest so far. Returns the rays
    /// whose crossing is at the same distance as that.
    Lanes (*keep_nearer)(RayTerms& terms, PacketNearest& nearest, const PacketCrossings& crossings, Lanes lanes,
                         std::uint32_t primitive);

    /// Unit normals of the surface of a product of half-spaces where `lanes` cross it, at distance end[k]; they point
    /// against rays that enter.
    void (*convex_normals)(const ConvexView& density, const RayPacket& rays, const double* end, Lanes lanes,
                           const PacketNearest& nearest, double (*normal)[RayPacket::size]);

    /// first_crossing() of convex_density.hpp for each ray of `lanes`, whose spans must be finite, with t_tolerance = 8
    /// ε (scale + |from|). Returns the rays that have a crossing.
    Lanes (*convex_crossings)(const ConvexView& density, const RayPacket& rays, Lanes lanes, const PacketSpans& spans,
                              double scale, PacketCrossings& found, std::uint64_t& evaluations);

    /// any_crossing() of convex_density.hpp, under the same conditions.
    Lanes (*convex_any_crossings)(const ConvexView& density, const RayPacket& rays, Lanes lanes,
                                  const PacketSpans& spans, double scale, std::uint64_t& evaluations);

    /// First crossings of the surface of a round part, and its normals there.
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

    /// Visits the items of a tree whose box a ray, or any ray of a beam, may meet, nearest first except where boxes
    /// overlap.
    void (*walk_ray)(const BoxTree& tree, const BoxRay& ray, BoxVisitor visitor);
    void (*walk_beam)(const BoxTree& tree, const BoxBeam& beam, BoxVisitor visitor);
};

/// The kernels for every instruction set that this machine has, the widest first.
std::vector<Instructions<PacketFunctions>> packet_instructions();

/// The kernels for the widest instruction set that this machine has.
extern const PacketFunctions& packet_functions;

}  // namespace deburr
