#include "polygonizer/mesh/sharp_parts.hpp"

#include <algorithm>

#include "bounds/box_range.hpp"
#include "bounds/density_part.hpp"
#include "bounds/round_density.hpp"

namespace deburr {
namespace {

constexpr std::size_t max_leaves = 256;  // that one density may become

struct Kinds {
    bool sharp = false, rounded = false;
};

Kinds kinds(const DensityTree& tree) {
    Kinds k;
    for (const HalfSpace& h : tree.half_spaces) (h.radius > 0 ? k.rounded : k.sharp) = true;
    return k;
}

bool has_round(const DensityTree& tree) {
    return std::any_of(tree.half_spaces.begin(), tree.half_spaces.end(),
                       [](const HalfSpace& h) { return h.round != nullptr; });
}

bool same_plane(const HalfSpace& g, const HalfSpace& h) {
    return g.normal == h.normal && g.offset == h.offset && g.radius == h.radius && g.round == h.round;
}

bool same(const DensityTree& a, const DensityTree& b) {
    const auto same_node = [](const TreeNode& m, const TreeNode& n) {
        return m.op == n.op && m.a == n.a && m.b == n.b && m.value == n.value;
    };
    return a.ball == b.ball && std::ranges::equal(a.half_spaces, b.half_spaces, same_plane) &&
           std::ranges::equal(a.nodes, b.nodes, same_node);
}

class Separation {
public:
    explicit Separation(SolidTree& to) : to_(to), leaves_before_(to.leaves.size()) {}

    /// Adds the density's set and returns its root node, or −1 if it would take too many leaves. Until finish() is
    /// called, leaves with round parts are densities.
    int run(SolidLeaf leaf) {
        if (to_.leaves.size() - leaves_before_ > max_leaves) return -1;
        if (const auto* round = dynamic_cast<const RoundDensity*>(leaf.field.get()); round && round->has_sharp()) {
            leaf.density = round->as_written();
            leaf.field = nullptr;
        }
        if (leaf.field) return add(leaf);
        const Kinds k = kinds(leaf.density);
        const TreeNode& root = leaf.density.nodes.back();
        if (root.op == Op::constant) return add({root.value > 0.5 ? SolidOp::everything : SolidOp::nothing});
        if (!k.sharp || root.op == Op::half_space) return add(leaf);
        if (!k.rounded && !has_round(leaf.density)) return add(leaf);
        if (root.op == Op::complement) return join(SolidOp::subtract, add({SolidOp::everything}), part(leaf, root.a));
        const DensityTree a = part_below(leaf.density, root.a), b = part_below(leaf.density, root.b);
        if (!kinds(a).rounded || !kinds(b).rounded) {
            const SolidOp op = root.op == Op::difference                          ? SolidOp::subtract
                               : root.op == Op::sum || root.op == Op::disjunction ? SolidOp::unite
                                                                                  : SolidOp::intersect;
            return join(op, part(leaf, root.a), part(leaf, root.b));
        }
        return decide(leaf);
    }

    /// Turns leaves with round parts into fields. A sharp round part gets a radius, because its surface is the same for
    /// any.
    void finish() {
        for (std::size_t k = leaves_before_; k < to_.leaves.size(); ++k) {
            SolidLeaf& leaf = to_.leaves[k];
            if (leaf.field || !has_round(leaf.density)) continue;
            for (HalfSpace& h : leaf.density.half_spaces)
                if (h.radius == 0) h.radius = harmless_radius(h);
            leaf.field = std::make_shared<RoundDensity>(std::move(leaf.density));
            leaf.density = DensityTree::constant(0);
        }
    }

private:
    // A radius with which the filter of a round part that is alone stays clear of points where the coordinate has no
    // gradient.
    static double harmless_radius(const HalfSpace& h) {
        const double room = h.round->kind == RoundCoordinate::Kind::circle ? h.round->ring - h.offset : infinity;
        return 0.5 * std::min(std::abs(h.offset), room);
    }

    int part(const SolidLeaf& leaf, int root) {
        return run({part_below(leaf.density, root), leaf.material, leaf.line});
    }

    int decide(const SolidLeaf& leaf) {
        std::vector<Range> ranges;
        std::size_t sharp = 0;
        for (const HalfSpace& h : leaf.density.half_spaces) {
            if (h.radius == 0) sharp = ranges.size();
            ranges.push_back({0, 1});
        }
        const HalfSpace plane = leaf.density.half_spaces[sharp];
        const auto with = [&](double value) {
            for (std::size_t i = 0; i < ranges.size(); ++i)  // the same plane may occur twice
                if (same_plane(leaf.density.half_spaces[i], plane)) ranges[i] = {value, value};
            return run({prune(leaf.density, ranges).tree, leaf.material, leaf.line});
        };
        const int inside = with(1), outside = with(0);
        if (inside < 0 || outside < 0) return -1;
        DensityTree alone{{plane}, {{Op::half_space, 0, -1, 0, leaf.line}}};
        alone.rounds = leaf.density.rounds;
        const int s = add({std::move(alone), leaf.material, leaf.line});
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

    // Adds a leaf, or finds an equal one: what is equal on both sides of a sharp plane is one leaf, whose surface runs
    // on across the plane.
    int add(const SolidLeaf& leaf) {
        std::size_t k = leaves_before_;
        while (k < to_.leaves.size() &&
               (leaf.field || to_.leaves[k].field || !same(to_.leaves[k].density, leaf.density)))
            ++k;
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
            Separation separation(to);
            const int root = separation.run(leaf);
            if (root >= 0) {
                separation.finish();
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
