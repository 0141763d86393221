#include "bounds/canonical_solids.hpp"

#include <algorithm>
#include <cstring>
#include <unordered_set>

namespace deburr {
namespace {

const Affine identity;

template <class... Values>
void append(std::string& key, const Values&... values) {
    (key.append(reinterpret_cast<const char*>(&values), sizeof values), ...);
}

// Members are appended one by one, because padding between them is indeterminate.
void append_round(std::string& key, const RoundPart& part) {
    const RoundCoordinate& c = part.coordinate;
    append(key, c.kind, c.center, c.axis, c.across, c.along, c.ring, part.offset);
}

// Appends a part and its placement. Most parts of long unions are not placed, and the map of those is left out.
void append_placed(std::string& key, const CanonicalPlacement& part) {
    append(key, part.canonical, part.material);
    const bool placed = std::memcmp(&part.map, &identity, sizeof identity) != 0;
    key.push_back(char(placed));
    if (placed) append(key, part.map);
}

// Whether the map keeps lengths, and so filter radii. A computed rotation deviates from that by a few ε.
bool is_rigid(const Mat3& m) {
    const Mat3 gram = glm::transpose(m) * m;
    double worst = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) worst = std::max(worst, std::abs(gram[i][j] - (i == j)));
    return worst <= 64 * epsilon;
}

/// The solid below all materials and placements, which are added to `to`.
const Solid& peel(const Solid& solid, CanonicalPlacement& to) {
    const Solid* at = &solid;
    for (;;) {
        const SolidNode& node = at->node();
        if (node.kind == SolidNode::Kind::material)
            to.material = node.material();  // the innermost wins
        else if (node.kind == SolidNode::Kind::transform)
            to.map = compose(to.map, node.map());
        else
            return *at;
        at = &node.children()[0];
    }
}

/// The density below all rigid placements, which are added to `to`.
const Density& peel_rigid(const Density& density, CanonicalPlacement& to) {
    const Density* at = &density;
    while (at->node().kind == DensityNode::Kind::transform && is_rigid(at->node().map().linear)) {
        to.map = compose(to.map, at->node().map());
        at = &at->node().children()[0];
    }
    return *at;
}

// Numbers every node after its parts, with a stack of its own because chains may be long. parts(handle, visit) calls
// visit(part) for each part; make(handle) returns the node's number and may use the parts' numbers.
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

int CanonicalSolids::Numbering::number_of_appended() {
    const std::size_t start = ends_.empty() ? 0 : ends_.back();
    ends_.push_back(bytes_.size());
    const auto [at, is_new] = known_.insert(int(ends_.size()) - 1);
    if (!is_new) {
        ends_.pop_back();
        bytes_.resize(start);
    }
    return *at;
}

int CanonicalSolids::density(const Density& root) {
    return number_bottom_up(
        known_densities_, root,
        [](const Density& d, auto visit) {
            for (const Density& child : d.node().children())
                if (!child.node().is_plane()) visit(child);
        },
        [&](const Density& d) {
            const DensityNode& n = d.node();
            std::string& key = density_keys_.bytes();
            append(key, n.kind);
            if (n.kind == DensityNode::Kind::transform)
                append(key, n.map());
            else if (n.is_plane())
                append(key, n.normal(), n.offset());
            else if (n.kind == DensityNode::Kind::round)
                append_round(key, n.round());
            else if (n.kind == DensityNode::Kind::radius)
                append(key, n.radius());
            for (const Density& child : n.children()) {  // half-spaces, the most frequent children, need no number
                const DensityNode& c = child.node();
                key.push_back(c.is_plane() ? char(c.kind) + 1 : 0);
                if (c.is_plane())
                    append(key, c.normal(), c.offset());
                else
                    append(key, known_densities_.at(&c));
            }
            return density_keys_.number_of_appended();
        });
}

int CanonicalSolids::rounded(const SolidNode& node, const Density& of) {
    append(solid_keys_.bytes(), node.kind, node.radius(), node.convolved(), density(of));
    const int canonical = solid_keys_.number_of_appended();
    if (std::size_t(canonical) == solids_.size())
        solids_.push_back(node.convolved() ? Solid::convolved(node.radius(), of, node.line)
                                           : Solid::rounded(node.radius(), of, node.line));
    return canonical;
}

int CanonicalSolids::base(const Solid& root) {
    return number_bottom_up(
        known_solids_, root,
        [](const Solid& s, auto visit) {
            CanonicalPlacement ignored;
            for (const Solid& child : s.node().children()) {
                const Solid& part = peel(child, ignored);
                if (part.node().kind != SolidNode::Kind::rounded) visit(part);
            }
        },
        [&](const Solid& s) {
            std::vector<CanonicalPlacement> parts;  // before the key is begun, because parts may have to be numbered
                                                    // first
            for (const Solid& child : s.node().children()) parts.push_back(of(child));
            append(solid_keys_.bytes(), s.node().kind, s.node().field().get());
            for (const CanonicalPlacement& part : parts) append_placed(solid_keys_.bytes(), part);
            const int canonical = solid_keys_.number_of_appended();
            if (std::size_t(canonical) == solids_.size()) solids_.push_back(s);
            return canonical;
        });
}

CanonicalPlacement CanonicalSolids::of(const Solid& solid) {
    CanonicalPlacement to;
    const Solid& at = peel(solid, to);
    const SolidNode& node = at.node();
    if (node.kind == SolidNode::Kind::rounded) {
        const Density& inner = peel_rigid(node.density(), to);
        to.canonical = rounded(node, inner);
    } else {
        to.canonical = base(at);  // returns at once where base() is under way, as the parts are numbered by then
    }
    return to;
}

double half_spaces_to_lay_out(const std::vector<Solid>& solids) {
    std::unordered_set<const SolidNode*> met;
    double sum = 0;
    const auto enter = [&](const SolidNode& node) {
        if (!met.insert(&node).second) return false;
        if (is_laid_out(node)) sum += node.leaves;
        return !is_laid_out(node);
    };
    for_each_leaf(solids, enter, [](const Solid&, const Affine&) {});
    return sum;
}

}  // namespace deburr
