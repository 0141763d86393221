#include "raytracer/trace/cell_primitive.hpp"

#include <algorithm>

namespace deburr {
namespace {

CrossingScratch& scratch() {
    thread_local CrossingScratch memory;
    return memory;
}

void count_roots(TraceCounters& counters, const RootCounters& roots) {
    counters.segments += roots.segments;
    counters.splits += roots.splits;
    counters.evaluations += roots.evaluations;
}

}  // namespace

void CellPrimitives::add(LocalSolid&& local, const Box& box, int solid) {
    CellPrimitive p;
    p.box = box;
    p.solid = solid;
    const auto convex = local.convex();
    if (!convex || convex->density.planes.empty()) {
        p.kind = local.surface() ? CellPrimitive::Kind::surface
                 : local.sum()   ? CellPrimitive::Kind::sum
                                 : CellPrimitive::Kind::general;
        if (p.kind != CellPrimitive::Kind::general) p.material = local.material();
        p.index = std::uint32_t(locals_.size());
        locals_.push_back(std::move(local));
    } else {
        const ConvexDensity& d = convex->density;
        p.index = std::uint32_t(planes_.size());
        p.material = convex->material;
        if (d.planes.size() == 1) {
            p.kind = CellPrimitive::Kind::plane;
            // Normalized, and turned outward.
            const double length = glm::length(d.planes[0].slope) * (d.complement ? -1 : 1);
            planes_.push_back({d.planes[0].slope / length, d.planes[0].base / length});
        } else {
            p.kind = CellPrimitive::Kind::convex;
            p.sharp = std::uint8_t(d.sharp);
            p.soft = std::uint8_t(d.planes.size()) - p.sharp;
            p.complement = d.complement;
            planes_.insert(planes_.end(), d.planes.begin(), d.planes.end());
        }
    }
    primitives_.push_back(p);
}

std::size_t CellPrimitives::half_spaces(std::size_t i) const {
    const CellPrimitive& p = primitives_[i];
    switch (p.kind) {
        case CellPrimitive::Kind::plane: return 1;
        case CellPrimitive::Kind::convex: return std::size_t(p.soft) + p.sharp;
        default: return locals_[p.index].half_spaces();
    }
}

Lanes CellPrimitives::crossings(const CellPrimitive& p, const RayPacket& rays, Lanes lanes, const PacketSpans& spans,
                                PacketCrossings& found, TraceCounters& counters) const {
    if (p.kind == CellPrimitive::Kind::convex)
        return packet_functions.convex_crossings(view(p), rays, lanes, spans, tolerances_.scale, found,
                                                 counters.evaluations);
    if (p.kind == CellPrimitive::Kind::surface)
        return packet_functions.surface_crossings(*locals_[p.index].surface(), rays, lanes, spans, found);
    if (p.kind == CellPrimitive::Kind::sum) {
        RootCounters roots;
        const Lanes crossed = packet_functions.sum_crossings(sum(p), rays, lanes, spans,
                                                             locals_[p.index].tolerances().scale, found, roots);
        count_roots(counters, roots);
        return crossed;
    }
    const Lanes crossed = packet_functions.plane_crossings(planes_[p.index], rays, lanes, spans, found);
    counters.flat_hits += count(crossed);
    return crossed;
}

Lanes CellPrimitives::any_crossings(const CellPrimitive& p, const RayPacket& rays, Lanes lanes,
                                    const PacketSpans& spans, TraceCounters& counters) const {
    if (p.kind == CellPrimitive::Kind::convex)
        return packet_functions.convex_any_crossings(view(p), rays, lanes, spans, tolerances_.scale,
                                                     counters.evaluations);
    if (p.kind == CellPrimitive::Kind::sum) {
        RootCounters roots;
        const Lanes crossed =
            packet_functions.sum_any_crossings(sum(p), rays, lanes, spans, locals_[p.index].tolerances().scale, roots);
        count_roots(counters, roots);
        return crossed;
    }
    PacketCrossings found;
    return crossings(p, rays, lanes, spans, found, counters);
}

SurfaceCrossing CellPrimitives::general_crossing(const CellPrimitive& p, const Vec3& origin, const Vec3& direction,
                                                 double t0, double t1, bool any, TraceCounters& counters) const {
    CrossingScratch& memory = scratch();
    memory.criterion = criterion_;
    memory.counters = {};
    const SurfaceCrossing c = locals_[p.index].first_crossing(origin, direction, t0, t1, any, memory);
    counters.flat_hits += memory.counters.flat;
    count_roots(counters, memory.counters.roots);
    return c;
}

Vec3 CellPrimitives::normal(const CellPrimitive& p, const ConvexCrossing& crossing, const Vec3& origin,
                            const Vec3& direction) const {
    if (p.kind == CellPrimitive::Kind::plane) return planes_[p.index].slope;
    const Vec3 n = surface_normal(view(p), crossing, origin + direction * crossing.t);
    // n is turned out of the solid: against a ray that enters it.
    return (glm::dot(n, direction) < 0) == crossing.entering ? n : -n;
}

void CellPrimitives::normals(const CellPrimitive& p, const RayPacket& rays, const double* end, Lanes lanes,
                             const PacketNearest& nearest, double (*normal)[RayPacket::size]) const {
    if (p.kind == CellPrimitive::Kind::convex)
        return packet_functions.convex_normals(view(p), rays, end, lanes, nearest, normal);
    if (p.kind == CellPrimitive::Kind::surface)
        return packet_functions.surface_normals(*locals_[p.index].surface(), rays, end, lanes, nearest, normal);
    if (p.kind == CellPrimitive::Kind::sum)
        return packet_functions.sum_normals(sum(p), rays, end, lanes, nearest, normal);
    const Vec3& slope = planes_[p.index].slope;
    for_each_lane(lanes, [&](int k) {
        for (int axis = 0; axis < 3; ++axis) normal[axis][k] = slope[axis];
    });
}

// ---- boxes ---------------------------------------------------------------------------------------

namespace {

struct Extent {
    double lo, hi;
};

// The range of slope·x over the box, without the term of axis `skipped_axis` (−1: with all terms).
Extent extent(Vec3 slope, const Box& box, int skipped_axis) {
    Extent e{0, 0};
    for (int k = 0; k < 3; ++k) {
        if (k == skipped_axis || slope[k] == 0) continue;
        const double a = slope[k] * box.lo[k], b = slope[k] * box.hi[k];
        e.lo += std::min(a, b);
        e.hi += std::max(a, b);
    }
    return e;
}

// Cuts off the part of the box where surely slope·x + base > 0; with `two_sided`, also where surely it is < 0.
void cut(Box& box, const AlphaPlane& p, bool two_sided) {
    for (int k = 0; k < 3; ++k) {
        const double s = p.slope[k];
        if (s == 0) continue;
        const Extent others = extent(p.slope, box, k);
        // Rounded outward: where the plane is nearly parallel to the axis, a small error moves its position far along
        // it.
        const double rounding = 4 * epsilon * (std::abs(p.base) + std::max(std::abs(others.lo), std::abs(others.hi)));
        const double most = (-p.base - others.lo + rounding) / s, least = (-p.base - others.hi - rounding) / s;
        if (std::isfinite(most))
            (s > 0 ? box.hi[k] : box.lo[k]) = s > 0 ? std::min(box.hi[k], most) : std::max(box.lo[k], most);
        if (two_sided && std::isfinite(least))
            (s > 0 ? box.lo[k] : box.hi[k]) = s > 0 ? std::max(box.lo[k], least) : std::min(box.hi[k], least);
    }
}

// Whether P > ½ in the whole box.
bool surely_within(ConvexView d, const Box& box) {
    double P = 1;
    for (int i = 0; i < d.soft + d.sharp; ++i) {
        const double alpha = extent(d.planes[i].slope, box, -1).hi + d.planes[i].base;
        if (i >= d.soft)
            P *= alpha < 0;
        else
            P *= profile(alpha);
    }
    return P > 0.5;
}

// Cuts off the ends of the box that lie wholly within C = {P > ½}.
void cut_within(Box& box, ConvexView d) {
    for (int axis = 0; axis < 3; ++axis)
        for (const bool upper : {false, true})
            for (const double part : {0.5, 0.25, 0.125}) {
                Box end = box;
                const double at = upper ? box.hi[axis] - part * (box.hi[axis] - box.lo[axis])
                                        : box.lo[axis] + part * (box.hi[axis] - box.lo[axis]);
                (upper ? end.lo : end.hi)[axis] = at;
                if (!surely_within(d, end)) continue;
                (upper ? box.hi : box.lo)[axis] = at;
                break;
            }
}

}  // namespace

Box CellPrimitives::surface_box(std::size_t i, double margin) const {
    const CellPrimitive& p = primitives_[i];
    // A ray searches beyond the cell's walls by rounding.
    const Box cell = inflated(p.box, margin);
    Box box = cell;
    if (p.kind == CellPrimitive::Kind::plane) {
        cut(box, planes_[p.index], true);
    } else if (p.kind == CellPrimitive::Kind::convex) {
        const ConvexView d = view(p);
        constexpr int rounds = 2;
        for (int round = 0; round < rounds; ++round) {
            for (int k = 0; k < d.soft + d.sharp; ++k) cut(box, d.planes[k], false);
            if (box.finite()) cut_within(box, d);
        }
    }
    // If rounding left nothing, the whole cell.
    return box.empty() ? cell : intersection(inflated(box, margin), cell);
}

}  // namespace deburr
