// Finds where facets of a surface meet other than in shared edges or vertices: in segments, or by overlapping in a
// plane.
#pragma once
#include <optional>
#include <vector>

#include "bounds/union_find.hpp"
#include "polygonizer/mesh/triangle_tree.hpp"
#include "raytracer/model/exact_points.hpp"
#include "raytracer/model/triangle_surface.hpp"

namespace deburr {

/// All intersections of a surface's facets with each other.
class FacetIntersections {
public:
    /// A segment, or a point if both are equal, as indices of its ends in lexicographic order.
    struct Segment {
        int from, to;
    };

    /// Finds all intersections and adds their ends to `points`. `tree` holds the surface's facets. Keeps references to
    /// `surface` and `points`.
    FacetIntersections(const TriangleSurface& surface, const TriangleTree& tree, ExactPoints& points);

    /// Whether facet t meets another one.
    bool has_any(int t) const { return met_[t]; }
    /// The segments along which other facets pass through facet t or touch it.
    const std::vector<Segment>& segments(int t) const { return segments_[t]; }
    /// A number shared by facets that lie in one plane and overlap, directly or through others.
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
