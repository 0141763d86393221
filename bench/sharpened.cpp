#include "bench/sharpened.hpp"

#include <stdexcept>

namespace deburr::bench {
namespace {

// Recursive to the depth of the scene's expressions; not for scenes with long chains.
Density without_radii(const Density& density) {
    const DensityNode& n = density.node();
    const auto child = [&](std::size_t i) { return without_radii(n.children()[i]); };
    using Kind = DensityNode::Kind;
    switch (n.kind) {
        case Kind::half_space:
        case Kind::cover: return density;
        case Kind::radius: return child(0);
        case Kind::transform: return child(0).transformed(n.map());
        case Kind::complement: return ~child(0);
        default: break;
    }
    Density all = child(0);
    for (std::size_t i = 1; i < n.children().size(); ++i) {
        switch (n.kind) {
            case Kind::sum: all = Density::sum(all, child(i), n.line); break;
            case Kind::product: all = Density::product(all, child(i), n.line); break;
            case Kind::difference: all = Density::difference(all, child(i), n.line); break;
            case Kind::disjunction: all = all | child(i); break;
            case Kind::conjunction: all = all & child(i); break;
            default: throw std::logic_error("sharpened: an unknown operator of densities");
        }
    }
    return all;
}

}  // namespace

Solid sharpened(const Solid& solid) {
    const SolidNode& n = solid.node();
    using Kind = SolidNode::Kind;
    const auto child = [&](std::size_t i) { return sharpened(n.children()[i]); };
    switch (n.kind) {
        case Kind::rounded: return Solid::sharp(without_radii(n.density()), n.line);
        case Kind::material: return child(0).material(n.material());
        case Kind::transform: return child(0).transformed(n.map());
        default: break;
    }
    if (n.children().empty()) throw std::logic_error("sharpened: a solid that is no rounded density");
    Solid all = child(0);
    for (std::size_t i = 1; i < n.children().size(); ++i)
        all = n.kind == Kind::unite ? all | child(i) : n.kind == Kind::intersect ? all & child(i) : all - child(i);
    return all;
}

}  // namespace deburr::bench
