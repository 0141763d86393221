// The planes and lines on which vertices must stay when edges collapse, so that flat faces stay exactly flat, and
// creases and borders of materials stay lines of edges.
#pragma once
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "polygonizer/mesh/facets.hpp"

namespace deburr {

/// The planes and lines on which one vertex must stay.
struct VertexConstraint {
    ShortList<Vec3, 4> planes;    // unit normals of the flat facets around the vertex, each once
    ShortList<int, 4> line_ends;  // none, or the other ends of the two edges that must stay lines
    bool fixed = false;           // the vertex must not move at all; then the lists may be incomplete
};

/// The constraints of all vertices. They are found when they are asked for, and remembered until a facet around the
/// vertex changes.
class VertexConstraints {
public:
    /// Keeps a reference to the facets, and both spans. Vertices in a box of `dense` are fixed, and so are those on the
    /// border, for which `border`, by vertex, is not 0; vertices beyond its end are not on the border.
    VertexConstraints(const Facets& facets, std::span<const char> border, std::span<const Box> dense);

    /// The constraint of vertex v, valid until update() for a facet around it.
    const VertexConstraint& at(int v);
    bool is_on_border(int v) const { return std::size_t(v) < border_.size() && border_[v]; }
    /// The normal of a flat facet, which all of its corners have; 0 if the facet is curved.
    Vec3 flat_normal(const Facet& facet) const;
    Vec3 flat_normal(int f) const { return flat_normals_[f]; }
    /// Learns that facet f is new.
    void update(int f);

private:
    VertexConstraint find(int v) const;
    bool is_line(int f, int g, int v) const;

    const Facets& facets_;
    const std::span<const char> border_;
    const std::span<const Box> dense_;
    std::vector<Vec3> flat_normals_;                     // by facet
    std::deque<std::optional<VertexConstraint>> known_;  // by vertex; a deque, which keeps references when it grows
};

}  // namespace deburr
