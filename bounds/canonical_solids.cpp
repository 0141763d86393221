#include "bounds/canonical_solids.hpp"

#include <algorithm>

namespace deburr {
namespace {

template <class... Values>
std::string key_of(const Values&... values) {
    std::string key;
    (key.append(reinterpret_cast<const char*>(&values), sizeof values), ...);
    return key;
}

// Rounding knows lengths only. What floating point makes of a rotation deviates by a few ε.
bool is_rigid(const Mat3& m) {
    const Mat3 gram = glm::transpose(m) * m;
    double worst = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) worst = std::max(worst, std::abs(gram[i][j] - (i == j)));
    return worst <= 64 * epsilon;
}

const Solid& peel(const Solid& solid, PlacedForm& to) {
    const Solid* at = &solid;
    for (;;) {
        const SolidNode& node = at->node();
        if (node.kind == SolidNode::Kind::material)
            to.material = node.material;  // the innermost wins
        else if (node.kind == SolidNode::Kind::transform)
            to.map = compose(to.map, node.map);
        else
            return *at;
        at = &node.children[0];
    }
}

const Density& peel_rigid(const Density& density, PlacedForm& to) {
    const Density* at = &density;
    while (at->node().kind == DensityNode::Kind::transform && is_rigid(at->node().map.linear)) {
        to.map = compose(to.map, at->node().map);
        at = &at->node().children[0];
    }
    return *at;
}

// Numbers a node once all its parts are numbered, with a stack of its own: chains may be long.
// parts(handle, visit) calls visit(part); make(handle) may ask for the parts' numbers.
template <class Handle, class Parts, class Make>
int number_bottom_up(std::unordered_map<const void*, int>& known, const Handle& root, Parts parts, Make make) {
    std::vector<const Handle*> open{&root};
    while (!open.empty()) {
        const Handle& now = *open.back();
        const std::size_t before = open.size();
        if (!known.count(&now.node())) {
            parts(now, [&](const Handle& part) {
                if (!known.count(&part.node())) open.push_back(&part);
            });
            if (open.size() > before) continue;
            const int number = make(now);
            known.emplace(&now.node(), number);
        }
        open.pop_back();
    }
    return known.at(&root.node());
}

}  // namespace

int SolidForms::number(std::unordered_map<std::string, int>& all, const std::string& key, bool& fresh) {
    const auto [at, is_new] = all.emplace(key, int(all.size()));
    fresh = is_new;
    return at->second;
}

int SolidForms::density(const Density& root) {
    return number_bottom_up(
        known_densities_, root,
        [](const Density& d, auto visit) {
            for (const Density& child : d.node().children) visit(child);
        },
        [&](const Density& d) {
            const DensityNode& n = d.node();
            std::string key =
                n.kind == DensityNode::Kind::transform ? key_of(n.kind, n.map) : key_of(n.kind, n.normal, n.value);
            for (const Density& child : n.children) key += key_of(known_densities_.at(&child.node()));
            bool fresh;
            return number(density_keys_, key, fresh);
        });
}

int SolidForms::rounded(const SolidNode& node, const Density& of) {
    bool fresh;
    const int form = number(solid_keys_, key_of(node.kind, node.radius, node.convolved, density(of)), fresh);
    if (fresh)
        solids_.push_back(node.convolved ? Solid::convolved(node.radius, of, node.line)
                                         : Solid::rounded(node.radius, of, node.line));
    return form;
}

int SolidForms::base(const Solid& root) {
    return number_bottom_up(
        known_solids_, root,
        [](const Solid& s, auto visit) {
            PlacedForm ignored;
            for (const Solid& child : s.node().children) {
                const Solid& part = peel(child, ignored);
                if (part.node().kind != SolidNode::Kind::rounded) visit(part);
            }
        },
        [&](const Solid& s) {
            std::string key = key_of(s.node().kind, s.node().field.get());
            for (const Solid& child : s.node().children) {
                const PlacedForm part = of(child);
                key += key_of(part.form, part.map, part.material);
            }
            bool fresh;
            const int form = number(solid_keys_, key, fresh);
            if (fresh) solids_.push_back(s);
            return form;
        });
}

PlacedForm SolidForms::of(const Solid& solid) {
    PlacedForm to;
    const Solid& at = peel(solid, to);
    const SolidNode& node = at.node();
    if (node.kind == SolidNode::Kind::rounded) {
        const Density& inner = peel_rigid(node.density[0], to);
        to.form = rounded(node, inner);
    } else {
        to.form = base(at);  // at once, where base() is under way: it has numbered the parts
    }
    return to;
}

}  // namespace deburr
