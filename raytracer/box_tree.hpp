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
    std::int32_t collapse(const Builder& from, int root, int depth);
    Node node_of(const Builder& from, const std::vector<int>& children) const;

    std::vector<Node, LargePages<Node>> nodes_;  // the root first
    Box box_;
    Vec3 middle_{0.0};
    double per_unit_ = 1;
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

template <class Visit>
void BoxTree::visit(const Vec3& origin, const Vec3& direction, const Vec3& reciprocal, double t0, double t1, Visit visit) const {
    struct Entry {
        std::int32_t child;
        float t;
    };
    Entry stack[most_entries];
    int top = 0;

    const Vec3 start = (origin + direction * t0 - middle_) * per_unit_;
    float begin[3], inverse[3];
    int near[3];
    for (int k = 0; k < 3; ++k) {
        constexpr double most = 1e30;  // beyond it a direction does not leave its place
        begin[k] = float(start[k]);
        inverse[k] = float(std::clamp(reciprocal[k], -most, most));
        near[k] = inverse[k] < 0 ? 4 : 0;
    }
    const Float4 ox(begin[0]), oy(begin[1]), oz(begin[2]), ix(inverse[0]), iy(inverse[1]), iz(inverse[2]);
    // Distances from t0 on, in single precision, rounded up.
    const auto single = [&](double t) { return float((t - t0) * per_unit_) * (1 + 0x1p-22f); };
    float end = single(t1);
    std::int32_t now = 0;
    for (;;) {
        if (now >= 0) {
            const Node& n = nodes_[std::size_t(now)];
            const auto at = [](const float* side, Float4 o, Float4 i) { return (Float4::load(side) - o) * i; };
            const Float4 lo = max(max(at(n.side[0] + near[0], ox, ix), at(n.side[1] + near[1], oy, iy)),
                                  max(at(n.side[2] + near[2], oz, iz), Float4(0.0f)));
            const Float4 hi = min(min(at(n.side[0] + (near[0] ^ 4), ox, ix), at(n.side[1] + (near[1] ^ 4), oy, iy)),
                                  min(at(n.side[2] + (near[2] ^ 4), oz, iz), Float4(end)));
            unsigned met = not_above(lo, hi);
            if (met != 0) {
                if ((met & (met - 1)) == 0) {
                    now = n.child[__builtin_ctz(met)];
                    continue;
                }
                alignas(16) float t[4];
                lo.store(t);
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
            const double until = visit(std::uint32_t(~now));
            if (until < 0) return;
            if (until < infinity) end = std::min(end, single(until));
        }
        do {
            if (top == 0) return;
            --top;
        } while (stack[top].t > end);
        now = stack[top].child;
    }
}

template <class Visit>
void BoxTree::meeting(const Box& box, Visit visit) const {
    if (empty()) return;
    const Vec3 lo = (box.lo - middle_) * per_unit_, hi = (box.hi - middle_) * per_unit_;
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
