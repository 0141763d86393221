// A hierarchy over boxes, for rays: split by the surface-area heuristic (MacDonald & Booth 1990) in bins
// (Wald 2007), and then four boxes to a node, which halves the nodes that have to be waited for.
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
    struct Pair {  // of a binary hierarchy
        Box box[2];
        std::int32_t child[2];  // a pair, or the complement of a box's number
    };
    struct alignas(64) Node {
        float lo[3][4], hi[3][4];
        std::int32_t child[4];  // a node, or the complement of a box's number
    };

    static void build(std::vector<Pair>& pairs, const std::vector<Box>& boxes, std::vector<std::int32_t>& order,
                      std::int32_t pair, std::size_t first, std::size_t end, int depth);
    std::int32_t add_node(const std::vector<Pair>& pairs, const Pair& from);

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
    Open stack[512];
    int top = 0;
    Open now{0, 0};
    for (;;) {
        if (now.node < 0) {
            if (visit(~now.node)) return;
        } else {
            const Node& node = nodes_[std::size_t(now.node)];
            double from[4] = {0, 0, 0, 0}, to[4] = {limit, limit, limit, limit};
            for (int k = 0; k < 3; ++k) {
                const float* near = down[k] ? node.hi[k] : node.lo[k];
                const float* far = down[k] ? node.lo[k] : node.hi[k];
                for (int i = 0; i < 4; ++i) {
                    // A NaN, from a ray within a slab's plane, changes nothing.
                    const double a = (near[i] - near_origin[k]) * inverse[k], b = (far[i] - far_origin[k]) * inverse[k];
                    from[i] = a > from[i] ? a : from[i];
                    to[i] = b < to[i] ? b : to[i];
                }
            }
            // Those that are met, the nearest on top.
            const int bottom = top;
            for (int i = 0; i < 4; ++i) {
                if (!(from[i] <= to[i] * outward)) continue;
                int at = top++;
                for (; at > bottom && stack[at - 1].t < from[i]; --at) stack[at] = stack[at - 1];
                stack[at] = {node.child[i], from[i]};
            }
        }
        do {
            if (top == 0) return;
            now = stack[--top];
        } while (now.t > limit);
    }
}

template <class Visit>
void BoxHierarchy::meeting(const Box& box, Visit visit) const {
    if (nodes_.empty()) return;
    std::vector<std::int32_t> open{0};
    while (!open.empty()) {
        const Node& node = nodes_[std::size_t(open.back())];
        open.pop_back();
        for (int i = 0; i < 4; ++i) {
            bool meets = true;
            for (int k = 0; k < 3; ++k)
                meets &= double(node.lo[k][i]) <= box.hi[k] && double(node.hi[k][i]) >= box.lo[k];
            if (!meets) continue;
            if (node.child[i] < 0) visit(~node.child[i]);
            else open.push_back(node.child[i]);
        }
    }
}

}  // namespace deburr
