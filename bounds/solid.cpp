#include "bounds/solid.hpp"

#include <cassert>
#include <utility>

#include "bounds/expression.hpp"
#include "bounds/field.hpp"

namespace deburr {
namespace {

std::shared_ptr<SolidNode> make(SolidNode::Kind kind, Solid a, Solid b) {
    const double leaves = a.node().leaves + b.node().leaves;
    return std::make_shared<SolidNode>(kind, leaves, SolidNode::Operands{std::move(a), std::move(b)});
}

std::shared_ptr<SolidNode> make_rounded(double r, Density density, int line, bool convolved) {
    const double leaves = density.node().leaves;
    return std::make_shared<SolidNode>(SolidNode::Kind::rounded, leaves,
                                       SolidNode::Rounded{std::move(density), r, convolved}, line);
}

}  // namespace

std::span<const Solid> SolidNode::children() const {
    if (const auto* operands = std::get_if<Operands>(&parts_)) return *operands;
    if (const auto* transform = std::get_if<Transform>(&parts_)) return {&transform->child, 1};
    if (const auto* material = std::get_if<Material>(&parts_)) return {&material->child, 1};
    return {};
}

const std::shared_ptr<const Field>& SolidNode::field() const {
    static const std::shared_ptr<const Field> none;
    const auto* field = std::get_if<std::shared_ptr<const Field>>(&parts_);
    return field ? *field : none;
}

SolidNode::~SolidNode() {
    const std::span<const Solid> children = this->children();
    release(std::span<Solid>(const_cast<Solid*>(children.data()), children.size()));
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
    const double leaves = field->size();
    return Solid(std::make_shared<SolidNode>(SolidNode::Kind::field, leaves, std::move(field), line));
}

Solid operator|(Solid a, Solid b) { return Solid(make(SolidNode::Kind::unite, std::move(a), std::move(b))); }
Solid operator&(Solid a, Solid b) { return Solid(make(SolidNode::Kind::intersect, std::move(a), std::move(b))); }
Solid operator-(Solid a, Solid b) { return Solid(make(SolidNode::Kind::subtract, std::move(a), std::move(b))); }

Solid Solid::material(int index) const {
    return Solid(
        std::make_shared<SolidNode>(SolidNode::Kind::material, node_->leaves, SolidNode::Material{*this, index}));
}

Solid Solid::transformed(const Affine& map) const {
    return Solid(
        std::make_shared<SolidNode>(SolidNode::Kind::transform, node_->leaves, SolidNode::Transform{*this, map}));
}

}  // namespace deburr
