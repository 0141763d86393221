#include "polygonizer/mesh/sharp_parts.hpp"

#include <algorithm>

#include "bounds/box_range.hpp"

namespace deburr {
namespace {

constexpr std::size_t max_leaves = 256;  // that one density may turn into

DensityTree subtree(const DensityTree& from, int root) {
    std::vector<char> needed(std::size_t(root) + 1, false);
    needed.back() = true;
    for (int i = root; i >= 0; --i) {
        const TreeNode& n = from.nodes[i];
        if (!needed[i] || n.op == Op::half_space || n.op == Op::constant) continue;
        needed[n.a] = true;
        if (n.b >= 0) needed[n.b] = true;
    }
    DensityTree to;
    std::vector<int> new_index(needed.size(), -1);
    for (std::size_t i = 0; i < needed.size(); ++i) {
        if (!needed[i]) continue;
        TreeNode n = from.nodes[i];
        if (n.op == Op::half_space) {
            to.half_spaces.push_back(from.half_spaces[n.a]);
            n.a = int(to.half_spaces.size()) - 1;
        } else if (n.op != Op::constant) {
            n.a = new_index[n.a];
            if (n.b >= 0) n.b = new_index[n.b];
        }
        if (n.support >= 0) {
            to.supports.push_back(from.supports[n.support]);
            n.support = int(to.supports.size()) - 1;
        }
        new_index[i] = int(to.nodes.size());
        to.nodes.push_back(n);
    }
    return to;
}

struct Kinds {
    bool sharp = false, rounded = false;
};

Kinds kinds(const DensityTree& tree) {
    Kinds k;
    for (const HalfSpace& h : tree.half_spaces) (h.radius > 0 ? k.rounded : k.sharp) = true;
    return k;
}

bool same(const DensityTree& a, const DensityTree& b) {
    const auto same_plane = [](const HalfSpace& g, const HalfSpace& h) {
        return g.normal == h.normal && g.offset == h.offset && g.radius == h.radius;
    };
    const auto same_node = [](const TreeNode& m, const TreeNode& n) {
        return m.op == n.op && m.a == n.a && m.b == n.b && m.value == n.value;
    };
    return a.ball == b.ball && std::ranges::equal(a.half_spaces, b.half_spaces, same_plane) &&
           std::ranges::equal(a.nodes, b.nodes, same_node);
}

class Separation {
public:
    explicit Separation(SolidTree& to) : to_(to), leaves_before_(to.leaves.size()) {}

    /// Root of the density's set; −1 if it would take too many leaves.
    int run(const SolidLeaf& leaf) {
        const Kinds k = kinds(leaf.density);
        if (to_.leaves.size() - leaves_before_ > max_leaves) return -1;
        if (leaf.field) return add(leaf);
        if (leaf.density.nodes.back().op == Op::constant)
            return add({leaf.density.nodes.back().value > 0.5 ? SolidOp::everything : SolidOp::nothing});
        if (!k.sharp || !k.rounded) return add(leaf);
        const TreeNode& root = leaf.density.nodes.back();
        if (root.op == Op::complement) return join(SolidOp::subtract, add({SolidOp::everything}), part(leaf, root.a));
        const DensityTree a = subtree(leaf.density, root.a), b = subtree(leaf.density, root.b);
        if (!kinds(a).rounded || !kinds(b).rounded) {
            const SolidOp op = root.op == Op::difference                          ? SolidOp::subtract
                               : root.op == Op::sum || root.op == Op::disjunction ? SolidOp::unite
                                                                                  : SolidOp::intersect;
            return join(op, part(leaf, root.a), part(leaf, root.b));
        }
        return decide(leaf);
    }

private:
    int part(const SolidLeaf& leaf, int root) { return run({subtree(leaf.density, root), leaf.material, leaf.line}); }

    int decide(const SolidLeaf& leaf) {
        std::vector<Range> ranges;
        std::size_t sharp = 0;
        for (const HalfSpace& h : leaf.density.half_spaces) {
            if (h.radius == 0) sharp = ranges.size();
            ranges.push_back({0, 1});
        }
        const HalfSpace plane = leaf.density.half_spaces[sharp];
        const auto with = [&](double value) {
            for (std::size_t i = 0; i < ranges.size(); ++i)  // the same plane may be there twice
                if (leaf.density.half_spaces[i].normal == plane.normal &&
                    leaf.density.half_spaces[i].offset == plane.offset && leaf.density.half_spaces[i].radius == 0)
                    ranges[i] = {value, value};
            return run({prune(leaf.density, ranges).tree, leaf.material, leaf.line});
        };
        const int inside = with(1), outside = with(0);
        if (inside < 0 || outside < 0) return -1;
        const int s = add({DensityTree{{plane}, {{Op::half_space, 0, -1, 0, leaf.line}}}, leaf.material, leaf.line});
        return join(SolidOp::unite, join(SolidOp::intersect, inside, s), join(SolidOp::subtract, outside, s));
    }

    int join(SolidOp op, int a, int b) {
        if (a < 0 || b < 0) return -1;
        const SolidOp first = to_.nodes[a].op, second = to_.nodes[b].op;
        if (op == SolidOp::intersect || op == SolidOp::subtract) {
            if (first == SolidOp::nothing) return a;
            if (op == SolidOp::intersect && second == SolidOp::nothing) return b;
            if (op == SolidOp::intersect && first == SolidOp::everything) return b;
            if (op == SolidOp::subtract && second == SolidOp::nothing) return a;
        } else {
            if (first == SolidOp::nothing) return b;
            if (second == SolidOp::nothing) return a;
        }
        return add({op, a, b});
    }

    // What remains on both sides of a sharp plane is one leaf, whose surface goes on from one to the other.
    int add(const SolidLeaf& leaf) {
        std::size_t k = leaves_before_;
        while (k < to_.leaves.size() && (leaf.field || !same(to_.leaves[k].density, leaf.density))) ++k;
        if (k == to_.leaves.size()) to_.leaves.push_back(leaf);
        return add({SolidOp::leaf, int(k)});
    }
    int add(SolidTreeNode node) {
        to_.nodes.push_back(node);
        return int(to_.nodes.size()) - 1;
    }

    SolidTree& to_;
    std::size_t leaves_before_;
};

}  // namespace

SolidTree separate_sharp(const SolidTree& solid) {
    SolidTree to;
    std::vector<int> new_index;
    for (const SolidTreeNode& n : solid.nodes) {
        SolidTreeNode node = n;
        if (n.op == SolidOp::leaf) {
            const SolidLeaf& leaf = solid.leaves[n.a];
            const std::size_t leaves = to.leaves.size(), nodes = to.nodes.size();
            const int root = Separation(to).run(leaf);
            if (root >= 0) {
                new_index.push_back(root);
                continue;
            }
            to.leaves.resize(leaves);
            to.nodes.resize(nodes);
            to.leaves.push_back(leaf);
            node.a = int(to.leaves.size()) - 1;
        } else if (n.a >= 0) {
            node.a = new_index[n.a];
            node.b = new_index[n.b];
        }
        new_index.push_back(int(to.nodes.size()));
        to.nodes.push_back(node);
    }
    to.nodes.resize(std::size_t(new_index.back()) + 1);
    return to;
}

}  // namespace deburr
