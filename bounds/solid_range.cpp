#include "bounds/solid_range.hpp"

namespace deburr {

Side combine(SolidOp op, Side a, Side b) {
    if (op == SolidOp::subtract) {
        if (a == Side::outside || b == Side::inside) return Side::outside;
        return a == Side::inside && b == Side::outside ? Side::inside : Side::straddling;
    }
    const Side absorbing = op == SolidOp::unite ? Side::inside : Side::outside;
    if (a == absorbing || b == absorbing) return absorbing;
    return a == Side::straddling || b == Side::straddling ? Side::straddling : a;
}

namespace {

// Sides of the box with respect to all nodes; `of_leaf` returns that of a leaf.
template <class OfLeaf>
void classify_nodes(const SolidTree& tree, std::vector<Side>& sides, OfLeaf of_leaf) {
    sides.clear();
    for (const SolidTreeNode& n : tree.nodes) {
        switch (n.op) {
            case SolidOp::nothing: sides.push_back(Side::outside); break;
            case SolidOp::everything: sides.push_back(Side::inside); break;
            case SolidOp::leaf: sides.push_back(of_leaf(n.a)); break;
            default: sides.push_back(combine(n.op, sides[n.a], sides[n.b]));
        }
    }
}

// Marks the nodes that the root needs once subtrees that do not straddle are folded away.
void mark_needed(const SolidTree& tree, const std::vector<Side>& sides, std::vector<char>& needed) {
    needed.assign(tree.nodes.size(), false);
    needed.back() = true;
    for (std::size_t i = tree.nodes.size(); i-- > 0;) {
        if (!needed[i] || sides[i] != Side::straddling) continue;
        const SolidTreeNode& n = tree.nodes[i];
        if (n.op == SolidOp::leaf) continue;
        needed[n.a] = needed[n.b] = true;
    }
}

}  // namespace

SolidTree prune(const SolidTree& tree, const Box& box) {
    std::vector<Pruned> local(tree.leaves.size());  // only for densities
    std::vector<Side> sides;
    classify_nodes(tree, sides, [&](int leaf) {
        const SolidLeaf& of = tree.leaves[leaf];
        Pruned& here = local[leaf];
        if (of.field) {
            const std::optional<DensityTree> density = of.field->as_density(box);
            if (!density) return classify_field(of.field->range(box));
            here = prune(*density, box);
        } else {
            here = prune(of.density, box);
        }
        return classify(here.range);
    });
    std::vector<char> needed;
    mark_needed(tree, sides, needed);

    SolidTree to;
    std::vector<int> new_index(tree.nodes.size(), -1), new_leaf_index(tree.leaves.size(), -1);
    const auto add = [&](SolidTreeNode node) {
        to.nodes.push_back(node);
        return int(to.nodes.size()) - 1;
    };
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        if (!needed[i]) continue;
        SolidTreeNode n = tree.nodes[i];
        const auto side = [&](int child) { return sides[child]; };
        if (sides[i] == Side::outside) {
            new_index[i] = add({SolidOp::nothing});
        } else if (sides[i] == Side::inside) {
            new_index[i] = add({SolidOp::everything});
        } else if (n.op == SolidOp::leaf) {
            const SolidLeaf& leaf = tree.leaves[n.a];
            int& to_leaf = new_leaf_index[n.a];
            if (to_leaf < 0) {
                to_leaf = int(to.leaves.size());
                if (leaf.field && local[n.a].tree.nodes.empty()) {
                    to.leaves.push_back(leaf);
                    if (FieldPtr left = leaf.field->prune(box)) to.leaves.back().field = std::move(left);
                } else {
                    to.leaves.push_back({std::move(local[n.a].tree), leaf.material, leaf.line});
                }
            }
            new_index[i] = add({SolidOp::leaf, to_leaf});
        } else if (side(n.b) != Side::straddling) {  // b does not decide the operator, so a is left
            new_index[i] = new_index[n.a];
        } else if (side(n.a) != Side::straddling && n.op != SolidOp::subtract) {
            new_index[i] = new_index[n.b];
        } else {
            new_index[i] = add({n.op, new_index[n.a], new_index[n.b]});
        }
    }
    to.nodes.resize(std::size_t(new_index.back()) + 1);
    return to;
}

void local_sizes(const SolidTree& tree, std::span<const Box> boxes, LocalSolidSize* sizes) {
    struct LeafSize {
        Side side;
        int half_spaces;
    };
    thread_local std::vector<Side> sides;
    thread_local std::vector<char> needed;
    thread_local std::vector<LeafSize> of_leaves;  // of leaf l in box k at [l · count + k]
    thread_local std::vector<LocalSize> of_density;
    const std::size_t count = boxes.size();
    of_leaves.clear();
    of_density.resize(count);
    for (const SolidLeaf& leaf : tree.leaves) {
        if (!leaf.field) {
            local_sizes(leaf.density, boxes, of_density.data());
            for (const LocalSize& size : of_density) of_leaves.push_back({classify(size.range), size.half_spaces});
            continue;
        }
        for (const Box& box : boxes) {
            const std::optional<DensityTree> density = leaf.field->as_density(box);
            const LocalSize size = density ? local_size(*density, box) : leaf.field->local_size(box);
            of_leaves.push_back({density ? classify(size.range) : classify_field(size.range), size.half_spaces});
        }
    }
    for (std::size_t k = 0; k < count; ++k) {
        const auto of_leaf = [&](int leaf) -> const LeafSize& { return of_leaves[leaf * count + k]; };
        classify_nodes(tree, sides, [&](int leaf) { return of_leaf(leaf).side; });
        mark_needed(tree, sides, needed);
        sizes[k] = {sides.back(), 0, 0};
        for (std::size_t i = 0; i < tree.nodes.size(); ++i)
            if (needed[i] && tree.nodes[i].op == SolidOp::leaf && sides[i] == Side::straddling) {
                ++sizes[k].leaves;
                sizes[k].half_spaces += of_leaf(tree.nodes[i].a).half_spaces;
            }
    }
}

LocalSolidSize local_size(const SolidTree& tree, const Box& box) {
    LocalSolidSize size;
    local_sizes(tree, {&box, 1}, &size);
    return size;
}

}  // namespace deburr
