// Triangulates flat polygons with holes: a constrained Delaunay triangulation of their corners.
//
// The polygon is projected along the coordinate axis nearest to its normal, so that coordinates are unchanged and
// orientations are exact (planar_triangulation.hpp). Winding numbers tell which triangles are inside. A side that
// passes through another corner becomes two edges, and a triangle without area that has the whole side; or it becomes
// one edge again if the corner touches it only from the other side. Corners in one place are told apart by the sides
// that meet there.
//
// Where two sides cross, the one that passes nearer to an end of the other is routed through that end, as if it touched
// there. The triangle without area then lies beside the polygon, by the little by which the sides cross.
#pragma once
#include <array>
#include <vector>

#include "bounds/vec.hpp"

namespace deburr {

/// The result of triangulate().
struct PolygonTriangles {
    std::vector<std::array<int, 3>> triangles;  // vertex numbers
    bool crosses_itself = false;                // in projection; then some triangles may be clockwise or overlap
};

/// Triangles of the polygon whose border are `loops` of indices in `positions`: the outer loop counter-clockwise seen
/// against `normal`, holes clockwise, in any order. Vertices on straight sides and loops that touch are allowed.
///
/// Every edge of a loop is an edge of exactly one triangle, and every other edge is in two triangles that run through
/// it in opposite directions; only edges that loops run through in both directions may be missing. No triangle is
/// clockwise. If the border crosses itself, an edge may be in more triangles, but except for the border as often in one
/// direction as in the other.
PolygonTriangles triangulate(const std::vector<std::vector<int>>& loops, const std::vector<Vec3>& positions,
                             Vec3 normal);

/// PolygonTriangles::triangles alone.
std::vector<std::array<int, 3>> triangles_of(const std::vector<std::vector<int>>& loops,
                                             const std::vector<Vec3>& positions, Vec3 normal);

}  // namespace deburr
