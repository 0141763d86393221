// A hierarchy over boxes, for rays: binary, split by the surface-area heuristic (MacDonald & Booth
// 1990) in bins (Wald 2007).
//
// Boxes are kept in single precision, rounded outward; rays meet them in double precision, so that
// what a ray touches is never missed. The hierarchy does not depend on the number of threads.
#pragma once
#include <cstdint>
#include <vector>

#include "raytracer/ray_tracer.hpp"

namespace deburr {

class BoxHierarchy {
public:
    BoxHierarchy() = default;
    /// Finite boxes, none empty.
    explicit BoxHierarchy(const std::vector<Box>& boxes);

    /// Calls visit(box's number) for the boxes that the ray meets within [0, limit], nearer ones
    /// first as a rule, until one returns true; `limit` may shrink meanwhile.
    template <class Visit>
    void along(const Ray& ray, const double& limit, Visit visit) const;

    /// Calls visit(box's number) for all boxes that meet this one.
    template <class Visit>
    void meeting(const Box& box, Visit visit) const;

    /// The box around all.
    const Box& bounds() const { return bounds_; }

private:
    struct alignas(64) Node {
        float lo[2][3], hi[2][3];
        std::int32_t child[2];  // a node, or the complement of a box's number
    };

    void build(const std::vector<Box>& boxes, std::vector<std::int32_t>& order, std::int32_t node, std::size_t first,
               std::size_t end, int depth);
    void set(Node& node, int side, const Box& box) const;

    std::vector<Node> nodes_;  // the root first; none if there are no boxes
    Box bounds_;
};

template <class Visit>
void BoxHierarchy::along(const Ray& ray, const double& limit, Visit visit) const {
    if (nodes_.empty()) return;
    // Slabs are moved outward by what the origin is rounded by, instead of every box.
    double inverse[3], near_origin[3], far_origin[3];
    bool down[3];
    const Vec3 size = glm::max(glm::abs(ray.origin), glm::max(glm::abs(bounds_.lo), glm::abs(bounds_.hi)));
    for (int k = 0; k < 3; ++k) {
        const double slack = 4 * epsilon * (size[k] + size[0] + size[1] + size[2]);
        down[k] = ray.direction[k] < 0;
        inverse[k] = 1 / (ray.direction[k] + 0.0);  // −0 counts as 0
        near_origin[k] = ray.origin[k] + (down[k] ? -slack : slack);
        far_origin[k] = ray.origin[k] - (down[k] ? -slack : slack);
    }
    constexpr double outward = 1 + 8 * epsilon;
    struct Open {
        std::int32_t node;
        double t;
    };
    Open stack[128];
    int top = 0;
    std::int32_t now = 0;
    for (;;) {
        if (now < 0) {
            if (visit(~now)) return;
        } else {
            const Node& node = nodes_[std::size_t(now)];
            double t[2];
            bool met[2];
            for (int side = 0; side < 2; ++side) {
                double from = 0, to = limit;
                for (int k = 0; k < 3; ++k) {
                    // A NaN, from a ray within a slab's plane, changes nothing.
                    const double lo = node.lo[side][k], hi = node.hi[side][k];
                    const double a = ((down[k] ? hi : lo) - near_origin[k]) * inverse[k];
                    const double b = ((down[k] ? lo : hi) - far_origin[k]) * inverse[k];
                    from = a > from ? a : from;
                    to = b < to ? b : to;
                }
                t[side] = from;
                met[side] = from <= to * outward;
            }
            if (met[0] || met[1]) {
                const int first = met[0] && (!met[1] || t[0] <= t[1]) ? 0 : 1;
                if (met[0] && met[1]) stack[top++] = {node.child[1 - first], t[1 - first]};
                now = node.child[first];
                continue;
            }
        }
        do {
            if (top == 0) return;
            --top;
        } while (stack[top].t > limit);
        now = stack[top].node;
    }
}

template <class Visit>
void BoxHierarchy::meeting(const Box& box, Visit visit) const {
    if (nodes_.empty()) return;
    std::vector<std::int32_t> open{0};
    while (!open.empty()) {
        const Node& node = nodes_[std::size_t(open.back())];
        open.pop_back();
        for (int side = 0; side < 2; ++side) {
            bool meets = true;
            for (int k = 0; k < 3; ++k)
                meets &= double(node.lo[side][k]) <= box.hi[k] && double(node.hi[side][k]) >= box.lo[k];
            if (!meets) continue;
            if (node.child[side] < 0) visit(~node.child[side]);
            else open.push_back(node.child[side]);
        }
    }
}

}  // namespace deburr
