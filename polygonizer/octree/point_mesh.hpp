// A mesh under construction, whose points know all faces that meet in them.
#pragma once
#include <array>

#include "polygonizer/mesh/facets.hpp"
#include "polygonizer/octree/octree_points.hpp"

namespace deburr {

/// Indices in PointMesh::points.
using TriangleVertices = std::array<int, 3>;

/// The mesh under construction.
struct PointMesh {
    std::vector<SurfacePoint> points;
    std::vector<TriangleVertices> triangles;
    std::size_t polygons = 0;

    const SurfacePoint& point(int v) const { return points[v]; }
    Vec3 position(int v) const { return point(v).position; }
    /// A vector along the outward normal whose length is twice the area.
    Vec3 area_vector(const TriangleVertices& t) const {
        return glm::cross(position(t[1]) - position(t[0]), position(t[2]) - position(t[0]));
    }
    Vec3 middle(const TriangleVertices& t) const { return (position(t[0]) + position(t[1]) + position(t[2])) / 3.0; }
    Box box(const TriangleVertices& t) const {
        Box b;
        for (const int v : t) b = hull(b, {position(v), position(v)});
        return b;
    }

    /// An edge between two triangles.
    struct Edge {
        int p, q;         // in the direction of `left`
        int left, right;  // triangles
    };
    /// The edges pq, p < q, for which wanted(p, q) is true, in order of their ends.
    template <class Wanted>
    std::vector<Edge> edges(Wanted wanted) const;

    /// Puts a point on an edge, which makes two of each of its triangles; the new triangles come last.
    void divide(const Edge& e, SurfacePoint point);
    /// Puts a point into a triangle, which makes three of it.
    void divide(int triangle, SurfacePoint point);

    /// The finished mesh. Every corner of a triangle gets the normal of its point that suits the triangle best.
    /// `origins` becomes the origin of each triangle: its leaf and cell 0, or both −1 on a plane.
    Mesh mesh(std::vector<Origin>& origins) const;

private:
    struct Directed {
        int lo, hi, triangle;
        bool forward;
    };
    static std::vector<Edge> paired(std::vector<Directed> all);
};

template <class Wanted>
std::vector<PointMesh::Edge> PointMesh::edges(Wanted wanted) const {
    std::vector<Directed> all;
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const int a = triangles[t][k], b = triangles[t][(k + 1) % 3];
            if (wanted(std::min(a, b), std::max(a, b))) all.push_back({std::min(a, b), std::max(a, b), int(t), a < b});
        }
    return paired(std::move(all));
}

}  // namespace deburr
