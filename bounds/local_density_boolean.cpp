// Boolean parts of a local density: as decision nodes of a diagram, and the polarity of every half-space.
#include <algorithm>

#include "bounds/decision_diagram.hpp"
#include "bounds/local_density.hpp"

namespace deburr {

int LocalDensity::add_boolean(const DensityTree& tree, int root) {
    const TreeNode& top = tree.nodes[root];
    if (top.op == Op::half_space) {  // needs no diagram
        half_spaces_.push_back(tree.half_spaces[top.a]);
        polarity_.push_back(1);
        return add({Step::half_space, int(half_spaces_.size()) - 1});
    }
    const std::size_t first = half_spaces_.size();
    const DecisionDiagram diagram = build_diagram(tree, root);
    // Only the nodes that the diagram's root reaches are added.
    std::vector<char> reached(diagram.nodes.size(), false);
    reached[diagram.root] = true;
    for (int i = int(diagram.nodes.size()) - 1; i >= 2; --i)
        if (reached[i])
            for (const int child : diagram.nodes[i].children) reached[child] = true;

    // index in half_spaces_ by family and threshold; −1: not added yet
    std::vector<std::vector<int>> plane(diagram.families.size());
    for (std::size_t f = 0; f < plane.size(); ++f) plane[f].assign(diagram.families[f].thresholds.size(), -1);
    const auto plane_of = [&](int family, int threshold) {
        int& index = plane[family][threshold];
        if (index < 0) {
            const PlaneFamily& f = diagram.families[family];
            half_spaces_.push_back({f.normal, f.thresholds[threshold], f.radius, f.round});
            index = int(half_spaces_.size()) - 1;
        }
        return index;
    };

    std::vector<int> new_index(diagram.nodes.size(), -1);
    for (std::size_t i = 0; i < diagram.nodes.size(); ++i) {
        if (!reached[i]) continue;
        if (i < 2) {
            new_index[i] = add({Step::constant, -1, -1, double(i)});
            continue;
        }
        const Decision& d = diagram.nodes[i];
        if (d.thresholds.size() == 1 && d.children[0] < 2 && d.children[1] < 2) {
            const int h = add({Step::half_space, plane_of(d.family, d.thresholds[0])});
            new_index[i] = d.children[0] == 1 ? h : add({Step::complement, h, -1, 1.0});
            continue;
        }
        const Node node{Step::decision, int(children_.size()), int(d.thresholds.size())};
        for (const int t : d.thresholds) children_.push_back(plane_of(d.family, t));
        for (const int c : d.children) children_.push_back(new_index[c]);
        new_index[i] = add(node);
    }
    find_polarities(tree, root, first);
    return new_index[diagram.root];
}

// Polarities of the half-spaces from `first` on, which came from the Boolean function at node `root`.
void LocalDensity::find_polarities(const DensityTree& tree, int root, std::size_t first) {
    enum : unsigned char { rises = 1, falls = 2 };
    const auto flipped = [](unsigned char p) {
        return static_cast<unsigned char>((p & rises) << 1 | (p & falls) >> 1);
    };
    thread_local std::vector<unsigned char> of_node, of_plane;
    of_node.assign(tree.nodes.size(), 0);
    of_node[root] = rises;
    of_plane.assign(half_spaces_.size() - first, 0);
    // Half-spaces that the diagram took for one plane differ by less than this.
    constexpr double same_direction = 1e-8, same_radius = 1e-8, same_offset = 1e-11;
    for (int i = root; i >= 0; --i) {
        const TreeNode& n = tree.nodes[i];
        const unsigned char polarity = of_node[i];
        if (polarity == 0) continue;
        if (n.op == Op::half_space) {
            const HalfSpace& h = tree.half_spaces[n.a];
            for (std::size_t k = 0; k < of_plane.size(); ++k) {
                const HalfSpace& plane = half_spaces_[first + k];
                if ((h.round != nullptr) != (plane.round != nullptr) || (h.round && !h.round->is_same(*plane.round)))
                    continue;
                const double side = glm::dot(h.normal, plane.normal) < 0 ? -1 : 1;
                if (std::abs(side * h.offset - plane.offset) > same_offset * (1 + std::abs(h.offset)) ||
                    std::abs(h.radius - plane.radius) > same_radius * h.radius ||
                    largest(side * h.normal - plane.normal) > same_direction)
                    continue;
                of_plane[k] |= side > 0 ? polarity : flipped(polarity);
            }
        } else if (n.op != Op::constant) {
            for (const int child : {n.a, n.b})
                if (child >= 0) of_node[child] |= n.op == Op::complement ? flipped(polarity) : polarity;
        }
    }
    for (const unsigned char p : of_plane) polarity_.push_back(p == rises ? 1 : p == falls ? -1 : 0);
}

}  // namespace deburr
