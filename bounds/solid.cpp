#include "bounds/solid.hpp"

#include <cassert>
#include <utility>

#include "bounds/expression.hpp"
#include "bounds/field.hpp"

namespace deburr {
namespace {

using Kind = SolidNode::Kind;

std::shared_ptr<SolidNode> make(Kind kind, std::vector<Solid> children) {
    auto node = std::make_shared<SolidNode>();
    node->kind = kind;
    node->children = std::move(children);
    node->leaves = 0;
    for (const Solid& child : node->children) node->leaves += child.node().leaves;
    return node;
}

}  // namespace

SolidNode::~SolidNode() { release(children); }

static std::shared_ptr<SolidNode> make_rounded(double r, Density density, int line, bool convolved) {
    auto node = std::make_shared<SolidNode>();
    node->radius = r;
    node->convolved = convolved;
    node->line = line;
    node->leaves = density.node().leaves;
    node->density.push_back(std::move(density));
    return node;
}

Solid Solid::rounded(double r, Density density, int line) {
    assert(r >= 0);
    return Solid(make_rounded(r, std::move(density), line, false));
}

Solid Solid::convolved(double r, Density density, int line) {
    assert(r > 0 && !density.has_radius());
    return Solid(make_rounded(r, std::move(density), line, true));
}

Solid Solid::of_field(FieldPtr field, int line) {
    auto node = std::make_shared<SolidNode>();
    node->kind = Kind::field;
    node->line = line;
    node->leaves = field->size();
    node->field = std::move(field);
    return Solid(node);
}

Solid operator|(Solid a, Solid b) { return Solid(make(Kind::unite, {a, b})); }
Solid operator&(Solid a, Solid b) { return Solid(make(Kind::intersect, {a, b})); }
Solid operator-(Solid a, Solid b) { return Solid(make(Kind::subtract, {a, b})); }

Solid Solid::material(int index) const {
    auto node = make(Kind::material, {*this});
    node->material = index;
    return Solid(node);
}

Solid Solid::transformed(const Affine& map) const {
    auto node = make(Kind::transform, {*this});
    node->map = map;
    return Solid(node);
}

}  // namespace deburr
