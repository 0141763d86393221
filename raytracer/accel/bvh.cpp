#include "raytracer/accel/bvh.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace deburr {
namespace {

// Bound of the error of a ray in single precision where coordinates are at most 1: its origin and the boxes are rounded
// by 2⁻²⁵, their differences by 2⁻²⁴; reciprocal, direction and product each change a distance of at most 2√3 by a
// factor of 1 ± 2⁻²⁴. That is at most 12·2⁻²⁴.
constexpr double box_rounding = 0x1p-19;

}  // namespace

BoxFrame::BoxFrame(const Box& around) : middle(0.5 * (around.lo + around.hi)) {
    const double side = largest(around.hi - around.lo);
    if (side > 0) per_unit = 2 / side;
}

Bvh8::Bvh8(const Builder& from, int root) {
    if (root == Builder::nothing) return;
    box_ = from.parts_[root].box;
    frame_ = BoxFrame(box_);
    if (collapse(from, root, 0) < 0) {  // a single item
        nodes_.push_back(node_of(from, {root}));
        nodes_[0].child[0] = ~from.parts_[root].a;
    }
}

// Opens the child with the largest surface until there are eight, or until all are items.
std::int32_t Bvh8::collapse(const Builder& from, int root, int depth) {
    const auto part = [&](int i) -> const Builder::Part& { return from.parts_[i]; };
    if (part(root).b < 0) return ~part(root).a;
    if (depth >= BoxTree::max_depth)
        throw std::length_error("expected a tree of at most " + std::to_string(BoxTree::max_depth) + " levels");
    std::vector<int> children{part(root).a, part(root).b};
    while (children.size() < BoxNode::width) {
        int largest = -1;
        for (std::size_t i = 0; i < children.size(); ++i)
            if (part(children[i]).b >= 0 &&
                (largest < 0 || half_area(part(children[i]).box) > half_area(part(children[largest]).box)))
                largest = int(i);
        if (largest < 0) break;
        const int open = children[largest];
        children[largest] = part(open).a;
        children.push_back(part(open).b);
    }
    const auto number = std::int32_t(nodes_.size());
    nodes_.push_back(node_of(from, children));
    for (std::size_t i = 0; i < children.size(); ++i) {
        const std::int32_t child = collapse(from, children[i], depth + 1);
        nodes_[number].child[i] = child;
    }
    return number;
}

BoxNode Bvh8::node_of(const Builder& from, const std::vector<int>& children) const {
    BoxNode n;
    for (std::size_t i = 0; i < BoxNode::width; ++i) {
        n.child[i] = 0;
        for (int k = 0; k < 3; ++k) {
            n.side[k][i] = std::numeric_limits<float>::max();
            n.side[k][i + BoxNode::width] = -std::numeric_limits<float>::max();
            if (i >= children.size()) continue;
            const Box& box = from.parts_[children[i]].box;
            n.side[k][i] = float(frame_.to_local(box.lo)[k] - box_rounding);
            n.side[k][i + BoxNode::width] = float(frame_.to_local(box.hi)[k] + box_rounding);
        }
    }
    return n;
}

}  // namespace deburr
