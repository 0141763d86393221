// Triangles of a flat polygon with holes: a constrained Delaunay triangulation of its corners.
//
// The polygon is seen along the axis nearest to its normal, so that its coordinates stay as they are, and sides
// are decided exactly (planar_triangulation). Which triangles are within follows from winding numbers. A side
// that runs through another corner is made of two edges, and gets a triangle without area on top that has the side
// itself; or is made one again, where the corner touches it from the other side only. Corners that are in one place are
// told apart by the sides that meet there.
//
// Where two sides cross, the one that passes nearer to an end of the other is led through that end, as if it
// touched there. The triangle on top then lies beside the polygon, by the little by which they cross.
#pragma once
#include <array>
#include <vector>

#include "bounds/vec.hpp"

namespace deburr {

struct PolygonTriangles {
    std::vector<std::array<int, 3>> triangles;
    bool crosses_itself = false;  // seen along that axis: some triangles may be wrong way round, or overlap
};

/// `loops`: vertex numbers; the outer one counter-clockwise seen against `normal`, holes clockwise,
/// in any order. Every edge of a loop is an edge of exactly one triangle, and each other edge is in two that run
/// through it both ways; only what loops run through in both directions may be missing. No triangle is wrong way round.
/// Where the rim crosses itself, edges may be in more triangles, but what they are in one way beyond the rim they
/// are in the other way too. Vertices on a straight side are fine, and so are loops that touch.
PolygonTriangles triangulate(const std::vector<std::vector<int>>& loops, const std::vector<Vec3>& positions,
                             Vec3 normal);

/// Only the triangles.
std::vector<std::array<int, 3>> triangles_of(const std::vector<std::vector<int>>& loops,
                                             const std::vector<Vec3>& positions, Vec3 normal);

}  // namespace deburr
