// Where the facets of a surface meet in more than an edge or a corner that they share: in segments, or in one plane.
#pragma once
#include <optional>
#include <vector>

#include "bounds/union_find.hpp"
#include "polygonizer/mesh/triangle_tree.hpp"
#include "raytracer/model/exact_points.hpp"
#include "raytracer/model/triangle_surface.hpp"

namespace deburr {

class FacetIntersections {
public:
    /// A segment, or a point, by the numbers of its ends, in their order.
    struct Segment {
        int from, to;
    };

    /// Finds all. `tree`: of the surface's facets. Keeps references.
    FacetIntersections(const TriangleSurface& surface, const TriangleTree& tree, ExactPoints& points);

    /// Whether facet t meets another.
    bool has_any(int t) const { return met_[t]; }
    /// Where other facets pass through facet t, or touch it.
    const std::vector<Segment>& segments(int t) const { return segments_[t]; }
    /// A number that facets share which lie in one plane and overlap, or are joined by others that do.
    int cluster(int t) { return clusters_.find(t); }

private:
    void meet(int s, int t);
    void sides(int plane, int of, int (&side)[3]) const;
    bool overlap(int s, int t) const;
    std::optional<Segment> line_part(int s, int t, const int (&side)[3]);

    const TriangleSurface& surface_;
    ExactPoints& points_;
    UnionFind clusters_;
    std::vector<char> met_;
    std::vector<std::vector<Segment>> segments_;  // of each facet
};

}  // namespace deburr
