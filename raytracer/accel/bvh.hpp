// A tree of boxes, four to a node: which of many boxes a ray may meet, nearest first.
//
// Boxes are kept in single precision, and so is the ray: it only has to find every box that the exact
// ray touches. For that both are measured from the middle of the outermost box, in units of its half
// largest side, the ray starts where it enters that box, and every box is larger by what rounding can
// make of the numbers that are left.
#pragma once
#include <cstdint>
#include <vector>

#include "bounds/vec.hpp"
#include "raytracer/simd/float4.hpp"
#include "raytracer/util/large_pages.hpp"

namespace deburr {

/// Frame in which boxes and rays are measured, so that single precision is enough: coordinates in
/// `around` are −1 … 1.
struct BoxFrame {
    BoxFrame() = default;
    explicit BoxFrame(const Box& around);

    Vec3 to_local(const Vec3& x) const { return (x - middle) * per_unit; }
    /// At least the distance, and 0.
    float distance(double d) const { return std::max(0.0f, float(d * per_unit) * (1 + 0x1p-22f)); }

    Vec3 middle{0.0};
    double per_unit = 1;
};

class Bvh4 {
public:
    /// A binary tree to start from; every subtree of it that holds anything has a finite box.
    class Builder {
    public:
        static constexpr int nothing = -1;
        int item(std::uint32_t number, const Box& box);
        int join(int a, int b);  // of any two, also of nothing
        /// All of these, so that few rays meet many: by the surface-area heuristic.
        int join_by_area(std::vector<int> parts);
        const Box& box(int part) const { return parts_[part].box; }

    private:
        friend class Bvh4;
        struct Part {
            Box box;
            int a, b;  // b < 0: an item, its number in a
        };
        int split(std::vector<int>& order, std::size_t first, std::size_t end, int slot, int depth);
        std::vector<Part> parts_;
    };

    Bvh4() = default;
    Bvh4(const Builder& from, int root);

    const Box& box() const { return box_; }
    bool empty() const { return nodes_.empty(); }

    /// Precondition: [t0, t1] is the ray's part in box(), up to rounding; `inverse` is reciprocal(direction). Calls
    /// visit(i) for every item i whose box the ray may meet in [t0, t1], the nearest first but where boxes overlap.
    /// visit() returns the distance up to which the ray goes on; a negative one ends the search.
    template <class Visit>
    void visit(const Vec3& origin, const Vec3& direction, const Vec3& inverse, double t0, double t1, Visit visit) const;

    /// Several rays: where they enter box(), their directions, and how far the farthest goes on in it.
    struct Beam {
        Vec3 min_point, max_point, min_direction, max_direction;
        double longest;
    };
    /// visit() for all of them at once: calls visit(number of an item) for whatever one of them may meet, the
    /// nearest first but where boxes overlap. It returns how far the farthest goes on.
    template <class Visit>
    void visit_packet(const Beam& beam, Visit visit) const;

    /// Items from `number` on lie at `first`, so many bytes apart: they are fetched before they are visited.
    void items_lie_at(std::uint32_t number, const void* first, std::size_t stride) {
        items_ = {number, static_cast<const char*>(first), stride};
    }

    /// Calls visit(number of an item) for those whose boxes may meet this one.
    template <class Visit>
    void meeting(const Box& box, Visit visit) const;

private:
    // Three entries a level; what is joined by area is at most some 60 deep, a BSP some 70, lists in its
    // cells some 20.
    static constexpr int max_entries = 480, max_depth = max_entries / 3 - 1;

    // side[axis]: the four lower, then the four upper bounds. An empty slot: lower above upper.
    struct alignas(64) Node {
        float side[3][8];
        std::int32_t child[4];  // ≥ 0: a node, < 0: ~item
    };
    struct Items {
        std::uint32_t number = ~0u;
        const char* first = nullptr;
        std::size_t stride = 0;
    };
    void fetch_item(std::uint32_t i) const {
        if (i < items_.number) return;
        const char* item = items_.first + (i - items_.number) * items_.stride;
        for (std::size_t at = 0; at < items_.stride; at += 64) __builtin_prefetch(item + at);
    }
    template <class Meet, class Visit>
    void walk(float end, Meet meet, Visit visit) const;
    static float inverse_of(double x);
    std::int32_t collapse(const Builder& from, int root, int depth);
    Node node_of(const Builder& from, const std::vector<int>& children) const;

    Items items_;
    std::vector<Node, LargePages<Node>> nodes_;  // the root first
    Box box_;
    BoxFrame frame_;
};

/// Interval [lo, hi] of a ray within a box, its boundary included; empty if lo > hi.
struct BoxSpan {
    double lo, hi;
};

/// 1/d, but finite where d is 0.
inline double reciprocal(double d) { return std::abs(d) > 1e-300 ? 1 / d : std::copysign(1e300, d); }
inline Vec3 reciprocal(Vec3 d) { return {reciprocal(d.x), reciprocal(d.y), reciprocal(d.z)}; }

/// Interval of the ray within `box`, which must not be empty.
[[gnu::always_inline]] inline BoxSpan span_in(const Box& box, const Vec3& origin, const Vec3& inverse, double t0,
                                              double t1) {
    for (int k = 0; k < 3; ++k) {
        const double a = (box.lo[k] - origin[k]) * inverse[k], b = (box.hi[k] - origin[k]) * inverse[k];
        const double lo = a < b ? a : b, hi = a < b ? b : a;
        t0 = lo > t0 ? lo : t0;
        t1 = hi < t1 ? hi : t1;
    }
    return {t0, t1};
}

// meet(node, end, t[4]) → bits of the children that are met before `end`, and where.
template <class Meet, class Visit>
[[gnu::always_inline]] inline void Bvh4::walk(float end, Meet meet, Visit visit) const {
    struct Entry {
        std::int32_t child;
        float t;
    };
    Entry stack[max_entries];
    int top = 0;
    std::int32_t now = 0;
    for (;;) {
        if (now >= 0) {
            const Node& n = nodes_[now];
            alignas(16) float t[4];
            unsigned met = meet(n, end, t);
            if (met != 0) {
                if ((met & (met - 1)) == 0) {
                    now = n.child[__builtin_ctz(met)];
                    continue;
                }
                const int first = top;
                do {  // sorted by insertion, the nearest on top
                    const int k = __builtin_ctz(met);
                    met &= met - 1;
                    int slot = top++;
                    for (; slot > first && stack[slot - 1].t < t[k]; --slot) stack[slot] = stack[slot - 1];
                    stack[slot] = {n.child[k], t[k]};
                    // It is looked at soon, if not next.
                    if (n.child[k] >= 0)
                        __builtin_prefetch(&nodes_[n.child[k]]);
                    else
                        fetch_item(std::uint32_t(~n.child[k]));
                } while (met != 0);
                now = stack[--top].child;
                continue;
            }
        } else {
            end = visit(std::uint32_t(~now), end);
            if (end < 0) return;
        }
        do {
            if (top == 0) return;
            --top;
        } while (stack[top].t > end);
        now = stack[top].child;
    }
}

inline float Bvh4::inverse_of(double x) {
    constexpr double most = 1e30;  // beyond it a direction does not leave its place
    return float(std::clamp(x, -most, most));
}

template <class Visit>
void Bvh4::visit(const Vec3& origin, const Vec3& direction, const Vec3& reciprocals, double t0, double t1,
                 Visit visit) const {
    const Vec3 start = frame_.to_local(origin + direction * t0);
    float inverse[3];
    int near[3];
    for (int k = 0; k < 3; ++k) {
        inverse[k] = inverse_of(reciprocals[k]);
        near[k] = inverse[k] < 0 ? 4 : 0;
    }
    const Float4 ox(float(start.x)), oy(float(start.y)), oz(float(start.z)), ix(inverse[0]), iy(inverse[1]),
        iz(inverse[2]);
    walk(
        frame_.distance(t1 - t0),
        [&](const Node& n, float end, float* t) __attribute__((always_inline)) {
            const auto at = [](const float* side, Float4 o, Float4 i) { return (Float4::load(side) - o) * i; };
            const Float4 lo = max(max(at(n.side[0] + near[0], ox, ix), at(n.side[1] + near[1], oy, iy)),
                                  max(at(n.side[2] + near[2], oz, iz), Float4(0.0f)));
            const Float4 hi = min(min(at(n.side[0] + (near[0] ^ 4), ox, ix), at(n.side[1] + (near[1] ^ 4), oy, iy)),
                                  min(at(n.side[2] + (near[2] ^ 4), oz, iz), Float4(end)));
            lo.store(t);
            return not_above(lo, hi);
        },
        [&](std::uint32_t item, float end) {
            const double until = visit(item);
            return until < 0 ? -1.0f : until < infinity ? std::min(end, frame_.distance(until - t0)) : end;
        });
}

// Along an axis that all go up, or all down: each operation in single precision is monotone, also where it
// rounds, so what the extreme starts and directions give lies around what any of the rays gives. Along
// another: the places that any of them reaches. The boxes' slack is more than rounding makes of these.
template <class Visit>
void Bvh4::visit_packet(const Beam& beam, Visit visit) const {
    struct Directed {
        int axis, near;
        float to_near, to_far, inverse, other_inverse;  // from which start; divided by
    };
    struct Undirected {
        int axis;
        float lo, hi;
    };
    Directed directed[3];
    Undirected undirected[3];
    int directed_axes = 0, undirected_axes = 0;
    const Vec3 start = frame_.to_local(beam.min_point), other_start = frame_.to_local(beam.max_point);
    const double length = frame_.distance(beam.longest);
    for (int k = 0; k < 3; ++k) {
        const double least = beam.min_direction[k], most = beam.max_direction[k];
        const float a = float(start[k]), b = float(other_start[k]);
        if (least > 0)
            directed[directed_axes++] = {k, 0, b, a, inverse_of(reciprocal(most)), inverse_of(reciprocal(least))};
        else if (most < 0)
            directed[directed_axes++] = {k, 4, a, b, inverse_of(reciprocal(most)), inverse_of(reciprocal(least))};
        else
            undirected[undirected_axes++] = {k, float(std::max(a + least * length, -2.0)),
                                             float(std::min(b + most * length, 2.0))};
    }
    walk(
        frame_.distance(beam.longest),
        [&](const Node& n, float end, float* t) __attribute__((always_inline)) {
            Float4 lo(0.0f), hi(end);
            for (int i = 0; i < directed_axes; ++i) {
                const Directed& d = directed[i];
                const Float4 inverse(d.inverse), other_inverse(d.other_inverse);
                const Float4 near = Float4::load(n.side[d.axis] + d.near) - Float4(d.to_near);
                const Float4 far = Float4::load(n.side[d.axis] + (d.near ^ 4)) - Float4(d.to_far);
                lo = max(lo, min(near * inverse, near * other_inverse));
                hi = min(hi, max(far * inverse, far * other_inverse));
            }
            lo.store(t);
            unsigned met = not_above(lo, hi);
            for (int i = 0; i < undirected_axes; ++i) {
                const Undirected& u = undirected[i];
                met &= not_above(Float4::load(n.side[u.axis]), Float4(u.hi)) &
                       not_above(Float4(u.lo), Float4::load(n.side[u.axis] + 4));
            }
            return met;
        },
        [&](std::uint32_t item, float end) {
            const double until = visit(item);
            return until < 0 ? -1.0f : until < infinity ? std::min(end, frame_.distance(until)) : end;
        });
}

template <class Visit>
void Bvh4::meeting(const Box& box, Visit visit) const {
    if (empty()) return;
    const Vec3 lo = frame_.to_local(box.lo), hi = frame_.to_local(box.hi);
    std::vector<std::int32_t> open{0};
    while (!open.empty()) {
        const Node& n = nodes_[open.back()];
        open.pop_back();
        for (int i = 0; i < 4; ++i) {
            bool meets = true;
            for (int k = 0; k < 3; ++k) meets &= double(n.side[k][i]) <= hi[k] && double(n.side[k][i + 4]) >= lo[k];
            if (!meets) continue;
            if (n.child[i] < 0)
                visit(std::uint32_t(~n.child[i]));
            else
                open.push_back(n.child[i]);
        }
    }
}

}  // namespace deburr
