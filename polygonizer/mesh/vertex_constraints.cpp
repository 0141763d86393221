#include "polygonizer/mesh/vertex_constraints.hpp"

#include <algorithm>

namespace deburr {
namespace {

// A common edge of two facets is a crease if the cosine between their normals at a vertex is below this.
constexpr double crease = 0.9;

}  // namespace

VertexConstraints::VertexConstraints(const Facets& facets, std::span<const char> border, std::span<const Box> dense)
    : facets_(facets), border_(border), dense_(dense) {
    for (std::size_t f = 0; f < facets_.size(); ++f) flat_normals_.push_back(flat_normal(facets_.at(int(f))));
}

Vec3 VertexConstraints::flat_normal(const Facet& facet) const {
    const auto& n = facet.triangle.normal;
    const Vec3 a = facets_.normal(n[0]);
    for (const std::size_t k : {1, 2})
        if (n[k] != n[0] && glm::length(facets_.normal(n[k]) - a) >= same_normal) return Vec3(0.0);
    return a;
}

// Whether the edge at v between facets f and g must stay a line of edges: a crease, a border of materials, or the
// border of a flat face. Otherwise curved facets would spread over a flat face, tilted by less than the tolerance.
bool VertexConstraints::is_line(int f, int g, int v) const {
    if ((flat_normals_[f] == Vec3(0.0)) != (flat_normals_[g] == Vec3(0.0))) return true;
    const auto normal = [&](int of) {
        return facets_.normal(facets_.at(of).triangle.normal[facets_.corner_index(of, v)]);
    };
    return facets_.at(f).triangle.material != facets_.at(g).triangle.material ||
           glm::dot(normal(f), normal(g)) < crease;
}

VertexConstraint VertexConstraints::find(int v) const {
    VertexConstraint kept;
    const Vec3 x = facets_.position(v);
    kept.fixed =
        is_on_border(v) || std::any_of(dense_.begin(), dense_.end(), [&](const Box& box) { return box.contains(x); });
    if (kept.fixed) return kept;
    const auto& fan = facets_.around(v);
    for (const int f : fan) {
        const Vec3 n = flat_normals_[f];
        if (n != Vec3(0.0) && std::none_of(kept.planes.begin(), kept.planes.end(),
                                           [&](Vec3 p) { return glm::length(p - n) < same_normal; }))
            kept.planes.push_back(n);
    }
    for (const int f : fan) {
        const int u = facets_.at(f).triangle.vertex[(facets_.corner_index(f, v) + 1) % 3];
        const int g = facets_.across(v, u) == f ? facets_.across(u, v) : facets_.across(v, u);
        if (g < 0)
            kept.fixed = true;
        else if (is_line(f, g, v))
            kept.line_ends.push_back(u);
    }
    kept.fixed |= kept.planes.size() > 2 || (!kept.line_ends.empty() && kept.line_ends.size() != 2);
    return kept;
}

const VertexConstraint& VertexConstraints::at(int v) {
    if (std::size_t(v) >= known_.size()) known_.resize(std::size_t(facets_.vertices()));
    std::optional<VertexConstraint>& known = known_[v];
    if (!known) known = find(v);
    return *known;
}

void VertexConstraints::update(int f) {
    flat_normals_.resize(std::max(flat_normals_.size(), std::size_t(f) + 1));
    flat_normals_[f] = flat_normal(facets_.at(f));
    for (const int v : facets_.at(f).triangle.vertex)
        if (std::size_t(v) < known_.size()) known_[v].reset();
}

}  // namespace deburr
