#include "bounds/density.hpp"

#include <cassert>
#include <utility>

#include "bounds/expression.hpp"

namespace deburr {
namespace {

std::shared_ptr<const DensityNode> make(DensityNode::Kind kind, DensityNode::Parts parts, int line = 0) {
    return std::make_shared<DensityNode>(kind, std::move(parts), line);
}

DensityNode::Operands pair(Density a, Density b) { return {std::move(a), std::move(b)}; }

}  // namespace

DensityNode::DensityNode(Kind of_kind, Parts parts, int of_line)
    : kind(of_kind),
      has_radius(of_kind == DensityNode::Kind::radius),
      has_round(of_kind == DensityNode::Kind::round),
      may_be_illegal(of_kind == DensityNode::Kind::sum || of_kind == DensityNode::Kind::difference),
      line(of_line),
      parts_(std::move(parts)) {
    if (is_plane() || kind == DensityNode::Kind::round) return;
    leaves = 0;
    for (const Density& child : children()) {
        leaves += child.node().leaves;
        has_radius |= child.node().has_radius;
        has_round |= child.node().has_round;
        may_be_illegal |= child.node().may_be_illegal;
    }
    if (kind == DensityNode::Kind::disjunction || kind == DensityNode::Kind::conjunction ||
        kind == DensityNode::Kind::complement)
        may_be_illegal = false;
}

std::span<const Density> DensityNode::children() const {
    if (const auto* operands = std::get_if<Operands>(&parts_)) return *operands;
    if (const auto* transform = std::get_if<Transform>(&parts_)) return {&transform->child, 1};
    if (const auto* list = std::get_if<std::vector<Density>>(&parts_)) return *list;
    if (const auto* radius = std::get_if<Radius>(&parts_)) return {&radius->child, 1};
    if (const auto* one = std::get_if<Density>(&parts_)) return {one, 1};
    return {};
}

DensityNode::~DensityNode() {
    const std::span<const Density> children = this->children();
    release(std::span<Density>(const_cast<Density*>(children.data()), children.size()));
}

Density Density::half_space(Vec3 normal, double offset) {
    const double length = glm::length(normal);
    assert(length > 0);
    return Density(make(DensityNode::Kind::half_space, DensityNode::HalfSpace{normal / length, offset / length}));
}

Density Density::cover(Vec3 normal, double offset) {
    const double length = glm::length(normal);
    assert(length > 0);
    return Density(make(DensityNode::Kind::cover, DensityNode::HalfSpace{normal / length, offset / length}));
}

Density Density::round(const RoundCoordinate& coordinate, double offset) {
    return Density(make(DensityNode::Kind::round, std::make_unique<const RoundPart>(RoundPart{coordinate, offset})));
}

Density Density::sphere(Vec3 center, double radius) {
    return round(RoundCoordinate::distance_from_point(center), radius);
}

Density Density::cylinder(Vec3 from, Vec3 to, double radius) { return cone(from, to, radius, radius); }

Density Density::cone(Vec3 from, Vec3 to, double radius_from, double radius_to) {
    const double height = glm::distance(from, to), widening = radius_to - radius_from;
    const double slant = std::hypot(height, widening);
    const Vec3 axis = (to - from) / height;
    std::vector<Density> parts;
    const double across = height / slant;
    parts.push_back(round(RoundCoordinate::across_cone(from, axis, across, -widening / slant), across * radius_from));
    if (radius_from > 0) parts.push_back(half_space(-axis, -glm::dot(axis, from)));
    if (radius_to > 0) parts.push_back(half_space(axis, glm::dot(axis, to)));
    return product(std::move(parts));
}

Density Density::torus(Vec3 center, Vec3 axis, double radius, double tube) {
    return round(RoundCoordinate::distance_from_circle(center, axis, radius), tube);
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
    if (parts.size() == 1) return parts[0];
    if (parts.size() == 2) return product(parts[0], parts[1]);
    return Density(make(DensityNode::Kind::product, std::move(parts)));
}

Density Density::sum(Density a, Density b, int line) {
    return Density(make(DensityNode::Kind::sum, pair(std::move(a), std::move(b)), line));
}
Density Density::product(Density a, Density b, int line) {
    return Density(make(DensityNode::Kind::product, pair(std::move(a), std::move(b)), line));
}
Density Density::difference(Density a, Density b, int line) {
    return Density(make(DensityNode::Kind::difference, pair(std::move(a), std::move(b)), line));
}
Density Density::disjunction(Density a, Density b) {
    return Density(make(DensityNode::Kind::disjunction, pair(std::move(a), std::move(b))));
}
Density Density::conjunction(Density a, Density b) {
    return Density(make(DensityNode::Kind::conjunction, pair(std::move(a), std::move(b))));
}
Density Density::complement(Density a) { return Density(make(DensityNode::Kind::complement, std::move(a))); }

Density Density::radius(double r) const {
    assert(r >= 0);
    return Density(make(DensityNode::Kind::radius, DensityNode::Radius{*this, r}));
}

bool Density::has_radius() const { return node_->has_radius; }

Density Density::transformed(const Affine& map) const {
    return Density(make(DensityNode::Kind::transform, DensityNode::Transform{*this, map}));
}

}  // namespace deburr
