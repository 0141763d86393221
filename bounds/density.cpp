#include "bounds/density.hpp"

#include <cassert>
#include <utility>

#include "bounds/expression.hpp"

namespace deburr {
namespace {

using Kind = DensityNode::Kind;

double leaves_below(const DensityNode& node) {
    double sum = 0;
    for (const Density& child : node.children) sum += child.node().leaves;
    return sum;
}

}  // namespace

DensityNode::~DensityNode() { release(children); }

static std::shared_ptr<DensityNode> make(Kind kind, std::vector<Density> children, int line = 0) {
    auto node = std::make_shared<DensityNode>();
    node->kind = kind;
    node->children = std::move(children);
    node->leaves = leaves_below(*node);
    node->has_radius = kind == Kind::radius;
    node->may_be_illegal = kind == Kind::sum || kind == Kind::difference;
    for (const Density& child : node->children) {
        node->has_radius |= child.node().has_radius;
        node->may_be_illegal |= child.node().may_be_illegal;
    }
    if (kind == Kind::disjunction || kind == Kind::conjunction || kind == Kind::complement)
        node->may_be_illegal = false;
    node->line = line;
    return node;
}

static std::vector<Density> pair(Density a, Density b) {
    std::vector<Density> both;
    both.reserve(2);
    both.push_back(std::move(a));
    both.push_back(std::move(b));
    return both;
}

Density Density::half_space(Vec3 normal, double offset) {
    const double length = glm::length(normal);
    assert(length > 0);
    auto node = std::make_shared<DensityNode>();
    node->normal = normal / length;
    node->value = offset / length;
    return Density(node);
}

Density Density::box(Vec3 lo, Vec3 hi) {
    std::vector<Density> faces;
    faces.reserve(6);
    for (int k = 0; k < 3; ++k) {
        Vec3 n(0.0);
        n[k] = 1;
        faces.push_back(half_space(n, hi[k]));
        faces.push_back(half_space(-n, -lo[k]));
    }
    return product(std::move(faces));
}

Density Density::product(std::vector<Density> parts) {
    assert(!parts.empty());
    return parts.size() == 1 ? parts[0] : Density(make(Kind::product, std::move(parts)));
}

Density Density::sum(Density a, Density b, int line) {
    return Density(make(Kind::sum, pair(std::move(a), std::move(b)), line));
}
Density Density::product(Density a, Density b, int line) {
    return Density(make(Kind::product, pair(std::move(a), std::move(b)), line));
}
Density Density::difference(Density a, Density b, int line) {
    return Density(make(Kind::difference, pair(std::move(a), std::move(b)), line));
}
Density Density::disjunction(Density a, Density b) {
    return Density(make(Kind::disjunction, pair(std::move(a), std::move(b))));
}
Density Density::conjunction(Density a, Density b) {
    return Density(make(Kind::conjunction, pair(std::move(a), std::move(b))));
}
Density Density::complement(Density a) { return Density(make(Kind::complement, {a})); }

Density Density::radius(double r) const {
    assert(r >= 0);
    auto node = make(Kind::radius, {*this});
    node->value = r;
    return Density(node);
}

bool Density::has_radius() const { return node_->has_radius; }

Density Density::transformed(const Affine& map) const {
    auto node = make(Kind::transform, {*this});
    node->map = map;
    return Density(node);
}

}  // namespace deburr
