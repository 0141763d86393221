#include "bounds/bounding_box.hpp"

#include "bounds/polyhedron_box.hpp"

namespace deburr {

Box bounding_box(const BoundCsg& csg) {
    using Kind = BoundCsg::Kind;
    // By de Morgan, a complement is a matter of which of two sets a node stands for; nodes are made
    // for the one that is asked, from the root down.
    std::vector<char> negated(csg.nodes.size(), false);
    for (std::size_t i = csg.nodes.size(); i-- > 0;) {
        const BoundCsg::Node& n = csg.nodes[i];
        if (n.kind == Kind::plane || n.kind == Kind::nothing || n.kind == Kind::everything) continue;
        negated[std::size_t(n.a)] = n.kind == Kind::complement ? !negated[i] : negated[i];
        if (n.b >= 0) negated[std::size_t(n.b)] = negated[i];
    }
    std::vector<GatheredBox> all(csg.nodes.size());
    for (std::size_t i = 0; i < csg.nodes.size(); ++i) {
        const BoundCsg::Node& n = csg.nodes[i];
        const bool not_ = negated[i];
        const auto take = [&](int child) { return std::move(all[std::size_t(child)]); };
        switch (n.kind) {
            case Kind::nothing:
            case Kind::everything:
                if ((n.kind == Kind::nothing) != not_) all[i].rest = {};
                break;
            case Kind::plane: {
                const BoundPlane& p = csg.planes[std::size_t(n.a)];
                all[i].planes.push_back(not_ ? BoundPlane{-p.normal, -p.offset} : p);
                break;
            }
            case Kind::both: all[i] = not_ ? either(take(n.a), take(n.b)) : both(take(n.a), take(n.b)); break;
            case Kind::either: all[i] = not_ ? both(take(n.a), take(n.b)) : either(take(n.a), take(n.b)); break;
            case Kind::complement: all[i] = take(n.a); break;
        }
    }
    return all.back().box();
}

Box bounding_box(const DensityTree& tree) {
    const int support = tree.nodes.back().support;
    const Box box = support < 0 ? Box::everything() : tree.supports[std::size_t(support)];
    if (!bounds_hold(tree, Box::everything())) return box;
    return intersection(box, bounding_box(outer_bound(tree, 0.5)));
}

Box bounding_box(const SolidTree& tree) {
    std::vector<Box> all;
    for (const SolidTreeNode& n : tree.nodes) {
        const auto at = [&](int child) { return all[std::size_t(child)]; };
        switch (n.op) {
            case SolidOp::nothing: all.push_back({}); break;
            case SolidOp::everything: all.push_back(Box::everything()); break;
            case SolidOp::leaf: {
                const SolidLeaf& leaf = tree.leaves[std::size_t(n.a)];
                all.push_back(leaf.field ? leaf.field->bounding_box() : bounding_box(leaf.density));
                break;
            }
            case SolidOp::unite: all.push_back(hull(at(n.a), at(n.b))); break;
            case SolidOp::intersect: all.push_back(intersection(at(n.a), at(n.b))); break;
            case SolidOp::subtract: all.push_back(at(n.a)); break;
        }
    }
    return all.back();
}

}  // namespace deburr
