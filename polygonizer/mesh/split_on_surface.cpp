#include "polygonizer/mesh/split_on_surface.hpp"

namespace deburr {
namespace {

bool same(const LeafSurface& a, const LeafSurface& b) {
    return a.leaf == b.leaf && (a.leaf >= 0 || glm::length(a.normal - b.normal) < same_normal);
}

}  // namespace

LeafSurface surface_of(const Facets& facets, const Facet& facet) {
    if (facet.origin.leaf >= 0) return {facet.origin.leaf};
    const Vec3 n = facets.normal(facet.triangle.normal[0]);
    return {-1, n, glm::dot(n, facets.position(facet.triangle.vertex[0]))};
}

void add_surface(std::vector<LeafSurface>& pieces, const LeafSurface& piece) {
    for (const LeafSurface& known : pieces)
        if (same(known, piece)) return;
    pieces.push_back(piece);
}

std::optional<Change> split_on_surface(Facets& facets, const FacetJudge& judge, int f, std::size_t k, double share) {
    const Facet facet = facets.at(f);
    const int a = facet.triangle.vertex[k], b = facet.triangle.vertex[(k + 1) % 3];
    const int other = facets.across(a, b);
    const Facet beyond = facets.at(other);
    std::vector<LeafSurface> pieces;
    add_surface(pieces, surface_of(facets, facet));
    add_surface(pieces, surface_of(facets, beyond));
    const Vec3 xa = facets.position(a), xb = facets.position(b);
    Vec3 x = xa + (xb - xa) * share;
    if (!judge.surfaces().project(x, pieces, glm::length(xb - xa)) || !judge.on_surface(x)) return {};
    const int vertex = facets.add_vertex(x);
    const auto normal_on = [&](int g, const Facet& of_g) {
        const auto& normals = of_g.triangle.normal;
        if (of_g.origin.leaf < 0) return normals[0];
        const Vec3 n = judge.surfaces().at({of_g.origin.leaf}, x).normal;
        const Vec3 na = facets.normal(normals[facets.corner_index(g, a)]);
        const Vec3 nb = facets.normal(normals[facets.corner_index(g, b)]);
        return facets.add_normal(glm::dot(n, na + nb) < 0 ? -n : n);
    };
    const int n = normal_on(f, facet);
    const int m = pieces.size() == 1 ? n : normal_on(other, beyond);
    return facets.split(f, k, vertex, n, m);
}

}  // namespace deburr
