#include "bounds/emptiness.hpp"

#include <deque>

#include "bounds/decision_diagram.hpp"
#include "bounds/local_density.hpp"
#include "bounds/solid_range.hpp"

namespace deburr {
namespace {

// The largest number of half-spaces of which a local density is made here. Its range is tighter than the tree's, as it
// sees what operands share, and takes longer.
constexpr std::size_t max_made_local = 24;

// A box shorter than this fraction of the whole is not halved: sets that are thinner stay unknown.
constexpr double thinnest_known = 1e-9;

// A half-space's density varies over this number of radii at most.
constexpr double reach = 2;

struct UnknownBox {
    SolidTree tree;  // pruned to the box
    Box box;
};

std::int64_t size_of(const SolidTree& tree) {
    std::size_t size = tree.nodes.size();
    for (const SolidLeaf& leaf : tree.leaves)
        size += leaf.field ? std::size_t(leaf.field->size()) : leaf.density.nodes.size();
    return std::int64_t(size);
}

// The box's side with respect to the solid, by the tightest ranges of the leaves.
Side side_of(const SolidTree& tree, const Box& box) {
    std::vector<Side> sides;
    for (const SolidTreeNode& n : tree.nodes) switch (n.op) {
            case SolidOp::nothing: sides.push_back(Side::outside); break;
            case SolidOp::everything: sides.push_back(Side::inside); break;
            case SolidOp::leaf: {
                const SolidLeaf& leaf = tree.leaves[n.a];
                Side side = Side::straddling;
                if (!leaf.field && leaf.density.half_spaces.size() <= max_made_local) try {
                        side = classify(LocalDensity(leaf.density).range(box));
                    } catch (const TooEntangled&) {  // then nothing more is known of the leaf
                    }
                sides.push_back(side);
                break;
            }
            default: sides.push_back(combine(n.op, sides[n.a], sides[n.b]));
        }
    return sides.back();
}

// The axis along which α of some half-space changes most over the box; the longest axis if none changes.
int axis_to_halve(const UnknownBox& now) {
    const Vec3 size = now.box.hi - now.box.lo;
    const double longest = max_component(size);
    Vec3 change(0.0);
    for (const SolidLeaf& leaf : now.tree.leaves)
        for (const HalfSpace& h : leaf.density.half_spaces)
            for (int k = 0; k < 3; ++k) {
                const double alpha = std::abs(h.normal[k]) * size[k] / std::max(h.radius, thinnest_known * longest);
                change[k] = std::max(change[k], std::min(alpha, reach) + 1e-3 * size[k] / longest);
            }
    if (change == Vec3(0.0)) change = size;
    int axis = 0;
    for (int k = 1; k < 3; ++k)
        if (change[k] > change[axis]) axis = k;
    return axis;
}

}  // namespace

Emptiness emptiness(const SolidTree& tree, const Box& box, std::int64_t& nodes) {
    if (box.empty()) return Emptiness::empty;
    std::deque<UnknownBox> open;
    bool unknown = false;
    // Returns true if the part of the box has a point of the set; otherwise keeps it for halving if it may have one.
    const auto examine = [&](const SolidTree& from, const Box& part) {
        nodes -= size_of(from);
        UnknownBox here{prune(from, part), part};
        if (here.tree.nodes.back().op == SolidOp::nothing) return false;
        if (here.tree.contains(0.5 * (part.lo + part.hi))) return true;
        nodes -= 4 * size_of(here.tree);
        const Side side = side_of(here.tree, part);
        if (side == Side::straddling) open.push_back(std::move(here));
        return side == Side::inside;
    };
    if (examine(tree, box)) return Emptiness::not_empty;
    const double least = thinnest_known * glm::length(box.hi - box.lo);
    while (!open.empty() && nodes > 0) {
        const UnknownBox now = std::move(open.front());
        open.pop_front();
        const int axis = axis_to_halve(now);
        if (now.box.hi[axis] - now.box.lo[axis] < least) {
            unknown = true;
            continue;
        }
        Box low = now.box, high = now.box;
        low.hi[axis] = high.lo[axis] = 0.5 * (now.box.lo[axis] + now.box.hi[axis]);
        if (examine(now.tree, low) || examine(now.tree, high)) return Emptiness::not_empty;
    }
    return open.empty() && !unknown ? Emptiness::empty : Emptiness::unknown;
}

Emptiness emptiness(const DensityTree& tree, const Box& box, std::int64_t& nodes) {
    SolidTree solid;
    solid.leaves.push_back({tree});
    solid.nodes.push_back({SolidOp::leaf, 0});
    return emptiness(solid, box, nodes);
}

}  // namespace deburr
