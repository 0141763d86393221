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
#include "raytracer/float4.hpp"
#include "raytracer/large_pages.hpp"

namespace deburr {

/// Where boxes and rays are measured from, and in what unit, so that single precision serves: in `around`
/// coordinates are −1 … 1.
struct BoxFrame {
    BoxFrame() = default;
    explicit BoxFrame(const Box& around);

    Vec3 place(const Vec3& x) const { return (x - middle) * per_unit; }
    /// At least the distance, and 0.
    float distance(double d) const { return std::max(0.0f, float(d * per_unit) * (1 + 0x1p-22f)); }

    Vec3 middle{0.0};
    double per_unit = 1;
};

class BoxTree {
public:
    /// A binary tree to start from; every subtree of it that holds anything has a finite box.
    class Builder {
    public:
        static constexpr int nothing = -1;
        int item(std::uint32_t number, const Box& box);
        int join(int a, int b);  // of any two, also of nothing
        /// All of these, so that few rays meet many: by the surface-area heuristic.
        int join_by_area(std::vector<int> parts);
        const Box& box(int part) const { return parts_[std::size_t(part)].box; }

    private:
        friend class BoxTree;
        struct Part {
            Box box;
            int a, b;  // b < 0: an item, its number in a
        };
        int split(std::vector<int>& order, std::size_t first, std::size_t end, int place, int depth);
        std::vector<Part> parts_;
    };

    BoxTree() = default;
    BoxTree(const Builder& from, int root);

    const Box& box() const { return box_; }
    bool empty() const { return nodes_.empty(); }

    /// The ray is within box() in [t0, t1], or nearly; `inverse`: reciprocal(direction). Calls visit(number of an item) for those whose
    /// boxes the ray may meet in [t0, t1], the nearest first but where boxes overlap. It returns the
    /// distance up to which it goes on; a negative one ends it.
    template <class Visit>
    void visit(const Vec3& origin, const Vec3& direction, const Vec3& inverse, double t0, double t1, Visit visit) const;

    /// A ray as the tree sees it, from a point of it on.
    struct Line {
        float start[3], inverse[3];
    };
    Line line(const Vec3& point, const Vec3& inverse) const;

    /// visit() for several rays at once, of whose lines these are the least and the most numbers, and none of
    /// which goes on for longer than `longest`: calls visit(number of an item) for all that visit() would for one of them, the nearest first but where boxes
    /// overlap. It returns how far from their starts the longest goes on.
    template <class Visit>
    void visit_together(const Line& least, const Line& most, double longest, Visit visit) const;

    /// Calls visit(number of an item) for those whose boxes may meet this one.
    template <class Visit>
    void meeting(const Box& box, Visit visit) const;

private:
    // Three entries a level; what is joined by area is at most some 60 deep, a BSP some 70, lists in its
    // cells some 20.
    static constexpr int most_entries = 480, deepest = most_entries / 3 - 1;

    // side[axis]: the four lower, then the four upper bounds. An empty slot: lower above upper.
    struct alignas(64) Node {
        float side[3][8];
        std::int32_t child[4];  // ≥ 0: a node, < 0: ~item
    };
    template <class Meet, class Visit>
    void walk(float end, Meet meet, Visit visit) const;
    std::int32_t collapse(const Builder& from, int root, int depth);
    Node node_of(const Builder& from, const std::vector<int>& children) const;

    std::vector<Node, LargePages<Node>> nodes_;  // the root first
    Box box_;
    BoxFrame frame_;
};

/// Where a ray is within a box: [lo, hi], none if lo > hi. Boundaries count.
struct BoxSpan {
    double lo, hi;
};

/// 1/d, but finite where d is 0.
inline Vec3 reciprocal(Vec3 d) {
    const auto of = [](double x) { return std::abs(x) > 1e-300 ? 1 / x : std::copysign(1e300, x); };
    return {of(d.x), of(d.y), of(d.z)};
}

/// Of a box that is not empty.
inline BoxSpan span_in(const Box& box, const Vec3& origin, const Vec3& inverse, double t0, double t1) {
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
[[gnu::always_inline]] inline void BoxTree::walk(float end, Meet meet, Visit visit) const {
    struct Entry {
        std::int32_t child;
        float t;
    };
    Entry stack[most_entries];
    int top = 0;
    std::int32_t now = 0;
    for (;;) {
        if (now >= 0) {
            const Node& n = nodes_[std::size_t(now)];
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
                    int place = top++;
                    for (; place > first && stack[place - 1].t < t[k]; --place) stack[place] = stack[place - 1];
                    stack[place] = {n.child[k], t[k]};
                    // It is looked at soon, if not next.
                    if (n.child[k] >= 0) __builtin_prefetch(&nodes_[std::size_t(n.child[k])]);
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

inline BoxTree::Line BoxTree::line(const Vec3& point, const Vec3& reciprocal) const {
    const Vec3 start = frame_.place(point);
    Line line;
    for (int k = 0; k < 3; ++k) {
        constexpr double most = 1e30;  // beyond it a direction does not leave its place
        line.start[k] = float(start[k]);
        line.inverse[k] = float(std::clamp(reciprocal[k], -most, most));
    }
    return line;
}

template <class Visit>
void BoxTree::visit(const Vec3& origin, const Vec3& direction, const Vec3& reciprocal, double t0, double t1, Visit visit) const {
    const Line ray = line(origin + direction * t0, reciprocal);
    int near[3];
    for (int k = 0; k < 3; ++k) near[k] = ray.inverse[k] < 0 ? 4 : 0;
    const Float4 ox(ray.start[0]), oy(ray.start[1]), oz(ray.start[2]), ix(ray.inverse[0]), iy(ray.inverse[1]), iz(ray.inverse[2]);
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

// Each operation in single precision is monotone, also where it rounds: what the extreme starts and directions
// give lies around what any of the rays gives. So what one of them meets alone, all meet together.
template <class Visit>
void BoxTree::visit_together(const Line& least, const Line& most, double longest, Visit visit) const {
    // Along an axis both of whose directions occur, nothing is known.
    struct Axis {
        int index, near;
        Float4 from_near, from_far, least, most;  // starts, and what is divided by
    };
    Axis axes[3];
    int known = 0;
    for (int k = 0; k < 3; ++k) {
        if (least.inverse[k] > 0)
            axes[known++] = {k, 0, Float4(most.start[k]), Float4(least.start[k]), Float4(least.inverse[k]), Float4(most.inverse[k])};
        else if (most.inverse[k] < 0)
            axes[known++] = {k, 4, Float4(least.start[k]), Float4(most.start[k]), Float4(least.inverse[k]), Float4(most.inverse[k])};
    }
    walk(
        frame_.distance(longest),
        [&](const Node& n, float end, float* t) __attribute__((always_inline)) {
            Float4 lo(0.0f), hi(end);
            for (int i = 0; i < known; ++i) {
                const Axis& a = axes[i];
                const Float4 near = Float4::load(n.side[a.index] + a.near) - a.from_near;
                const Float4 far = Float4::load(n.side[a.index] + (a.near ^ 4)) - a.from_far;
                lo = max(lo, min(near * a.least, near * a.most));
                hi = min(hi, max(far * a.least, far * a.most));
            }
            lo.store(t);
            const unsigned met = not_above(lo, hi);  // no empty slot, if an axis is known
            return known > 0 ? met : not_above(Float4::load(n.side[0]), Float4::load(n.side[0] + 4));
        },
        [&](std::uint32_t item, float end) {
            const double until = visit(item);
            return until < 0 ? -1.0f : until < infinity ? std::min(end, frame_.distance(until)) : end;
        });
}

template <class Visit>
void BoxTree::meeting(const Box& box, Visit visit) const {
    if (empty()) return;
    const Vec3 lo = frame_.place(box.lo), hi = frame_.place(box.hi);
    std::vector<std::int32_t> open{0};
    while (!open.empty()) {
        const Node& n = nodes_[std::size_t(open.back())];
        open.pop_back();
        for (int i = 0; i < 4; ++i) {
            bool meets = true;
            for (int k = 0; k < 3; ++k) meets &= double(n.side[k][i]) <= hi[k] && double(n.side[k][i + 4]) >= lo[k];
            if (!meets) continue;
            if (n.child[i] < 0) visit(std::uint32_t(~n.child[i]));
            else open.push_back(n.child[i]);
        }
    }
}

}  // namespace deburr
