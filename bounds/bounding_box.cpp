#include "bounds/bounding_box.hpp"

#include <algorithm>

#include "bounds/box_range.hpp"
#include "bounds/polyhedron_box.hpp"
#include "bounds/solid_range.hpp"
#include "bounds/support.hpp"

namespace deburr {

Box bounding_box(const BoundCsg& csg) {
    using Kind = BoundCsg::Kind;
    // By de Morgan's laws a complement only changes which of two sets a node stands for; every node's box is that of
    // the set that its parents ask for, as determined from the root down.
    std::vector<char> negated(csg.nodes.size(), false);
    for (std::size_t i = csg.nodes.size(); i-- > 0;) {
        const BoundCsg::Node& n = csg.nodes[i];
        if (n.kind == Kind::plane || n.kind == Kind::nothing || n.kind == Kind::everything) continue;
        negated[n.a] = n.kind == Kind::complement ? !negated[i] : negated[i];
        if (n.b >= 0) negated[n.b] = negated[i];
    }
    std::vector<GatheredBox> all(csg.nodes.size());
    for (std::size_t i = 0; i < csg.nodes.size(); ++i) {
        const BoundCsg::Node& n = csg.nodes[i];
        const bool not_ = negated[i];
        const auto take = [&](int child) { return std::move(all[child]); };
        switch (n.kind) {
            case Kind::nothing:
            case Kind::everything:
                if ((n.kind == Kind::nothing) != not_) all[i].rest = {};
                break;
            case Kind::plane: {
                const BoundPlane& p = csg.planes[n.a];
                all[i].planes.push_back(not_ ? BoundPlane{-p.normal, -p.offset} : p);
                break;
            }
            case Kind::intersect: all[i] = not_ ? unite(take(n.a), take(n.b)) : intersect(take(n.a), take(n.b)); break;
            case Kind::unite: all[i] = not_ ? intersect(take(n.a), take(n.b)) : unite(take(n.a), take(n.b)); break;
            case Kind::complement: all[i] = take(n.a); break;
        }
    }
    return all.back().box();
}

namespace {

// Cuts off the ends of a finite box over which the density does not exceed ½, to 10⁻⁹ of the box's size.
Box without_ends_below_half(const DensityTree& tree, Box box) {
    constexpr int halvings = 32;
    for (int k = 0; k < 6; ++k)  // narrowing one axis helps with the others
        for (const bool upper : {false, true}) {
            double& end = (upper ? box.hi : box.lo)[k % 3];
            // the set has nothing beyond `off`, and perhaps something beyond `on`
            double off = end, on = (upper ? box.lo : box.hi)[k % 3];
            for (int i = 0; i < halvings; ++i) {
                const double middle = 0.5 * (off + on);
                Box beyond = box;
                (upper ? beyond.lo : beyond.hi)[k % 3] = middle;
                (density_range(tree, beyond).hi <= 0.5 ? off : on) = middle;
            }
            end = off;
        }
    return box;
}

// The tree with planes in place of its round parts, such that its set holds the original one: a round part that adds to
// the solid becomes the half-spaces that touch it, one that takes away becomes nothing.
DensityTree flattened_around(const DensityTree& tree) {
    std::vector<char> takes(tree.nodes.size(), false);
    for (std::size_t i = tree.nodes.size(); i-- > 0;) {
        const TreeNode& n = tree.nodes[i];
        if (n.op == Op::half_space || n.op == Op::constant) continue;
        const bool complement = n.op == Op::complement;
        takes[n.a] = complement ? !takes[i] : takes[i];
        if (n.b >= 0) takes[n.b] = n.op == Op::difference ? !takes[i] : takes[i];
    }
    DensityTree to;
    std::vector<int> new_index(tree.nodes.size(), -1);
    const auto add = [&](TreeNode node) {
        to.nodes.push_back(node);
        return int(to.nodes.size()) - 1;
    };
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        TreeNode n = tree.nodes[i];
        n.support = -1;
        const HalfSpace* h = n.op == Op::half_space ? &tree.half_spaces[n.a] : nullptr;
        if (h && h->round) {
            int all = -1;
            if (!takes[i])
                for (const HalfSpace& touching : touching_planes(*h)) {
                    to.half_spaces.push_back(touching);
                    const int one = add({Op::half_space, int(to.half_spaces.size()) - 1});
                    all = all < 0 ? one : add({Op::conjunction, all, one});
                }
            new_index[i] = all >= 0 ? all : add({Op::constant, -1, -1, takes[i] ? 0.0 : 1.0});
            continue;
        }
        if (h) {
            to.half_spaces.push_back(*h);
            n.a = int(to.half_spaces.size()) - 1;
        } else if (n.op != Op::constant) {
            n.a = new_index[n.a];
            if (n.b >= 0) n.b = new_index[n.b];
        }
        new_index[i] = add(n);
    }
    return to;
}

}  // namespace

Box bounding_box(const DensityTree& tree) {
    const int support = tree.nodes.back().support;
    const Box box = support < 0 ? Box::everything() : tree.supports[support];
    if (tree.rounds) {
        const bool hold = bounds_hold(tree, Box::everything());
        const Box around = hold ? intersection(box, bounding_box(outer_bound(flattened_around(tree), 0.5))) : box;
        return around.finite() && !around.empty() ? without_ends_below_half(tree, around) : around;
    }
    if (!bounds_hold(tree, Box::everything())) return box;
    return intersection(box, bounding_box(outer_bound(tree, 0.5)));
}

namespace {

// Cuts infinite sides of a box down where ranges say that nothing of the solid lies beyond: an infinite field may be
// cut to something finite by others, as a cone is by its base, though the cone's own box is all of space.
Box without_empty_ends(const SolidTree& tree, Box box) {
    Box seen;
    for (const SolidLeaf& leaf : tree.leaves)
        if (leaf.field) seen = hull(seen, leaf.field->extent());
    if (box.empty() || box.finite() || seen.empty() || !seen.finite()) return box;
    const Vec3 middle = 0.5 * (seen.lo + seen.hi), size = seen.hi - seen.lo;
    const double least = max_component(size) * 0x1p-4;
    constexpr double most = 0x1p40;  // the farthest place looked at, in multiples of `least`
    constexpr double closer = 0.98;  // bisection ends where the two ends' distances differ by less than this factor
    for (int pass = 0; pass < 2; ++pass)  // narrowing one axis helps with the others
        for (int k = 0; k < 3; ++k)
            for (const bool upper : {false, true}) {
                if (std::isfinite((upper ? box.hi : box.lo)[k])) continue;
                const auto nothing_beyond = [&](double reach) {
                    Box beyond = box;
                    (upper ? beyond.lo : beyond.hi)[k] = middle[k] + (upper ? reach : -reach);
                    return beyond.empty() || local_size(tree, beyond).side == Side::outside;
                };
                double far = least;
                while (far < most * least && !nothing_beyond(far)) far *= 2;
                if (far >= most * least) continue;
                double near = 0.5 * far;
                while (near < closer * far) {
                    const double between = 0.5 * (near + far);
                    (nothing_beyond(between) ? far : near) = between;
                }
                (upper ? box.hi : box.lo)[k] = middle[k] + (upper ? far : -far);
            }
    return box;
}

}  // namespace

Box bounding_box(const SolidTree& tree) {
    std::vector<Box> all;
    for (const SolidTreeNode& n : tree.nodes) {
        const auto at = [&](int child) { return all[child]; };
        switch (n.op) {
            case SolidOp::nothing: all.push_back({}); break;
            case SolidOp::everything: all.push_back(Box::everything()); break;
            case SolidOp::leaf: {
                const SolidLeaf& leaf = tree.leaves[n.a];
                all.push_back(leaf.field ? leaf.field->bounding_box() : bounding_box(leaf.density));
                break;
            }
            case SolidOp::unite: all.push_back(hull(at(n.a), at(n.b))); break;
            case SolidOp::intersect: all.push_back(intersection(at(n.a), at(n.b))); break;
            case SolidOp::subtract: all.push_back(at(n.a)); break;
        }
    }
    return without_empty_ends(tree, all.back());
}

}  // namespace deburr
