// Judges how triangles of the octree's mesh lie to the surface: which of them lean from it or are too far off, so that
// the cells around them are to be cut further, and which diagonal of a quadrilateral leans less.
#pragma once
#include <vector>

#include "polygonizer/octree/octree_cells.hpp"
#include "polygonizer/octree/point_mesh.hpp"

namespace deburr {

/// How a triangle lies to the surface at its middle: the cosine of the angle between their normals, and their distance.
struct Standing {
    double cosine = 1, distance = 0;
};

/// Finds triangles that lean.
class LeaningTriangles {
public:
    /// Keeps references to the mesh and to the tree that it is made from; both may change. `tolerance` is the greatest
    /// distance of a triangle's middle from the surface, or infinity. `has_forms` says that the solid has free forms.
    LeaningTriangles(const PointMesh& mesh, const CellTree& tree, double tolerance, bool has_forms)
        : mesh_(mesh), tree_(tree), tolerance_(tolerance), has_forms_(has_forms) {}

    /// Whether the cells around this triangle should be cut further.
    bool leans(const TriangleVertices& triangle) const;
    /// Whether the diagonal from the first point of a quadrilateral is better than the other one.
    bool first_diagonal(const std::vector<int>& q) const;

private:
    Standing standing(const TriangleVertices& t) const;
    bool passes_near(Vec3 middle, Vec3 area) const;
    double cosine_to_points(const TriangleVertices& t) const;

    const PointMesh& mesh_;
    const CellTree& tree_;
    double tolerance_;
    bool has_forms_;
};

}  // namespace deburr
