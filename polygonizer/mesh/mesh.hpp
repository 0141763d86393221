// A triangle mesh with shared vertices, and the conditions that a closed surface has to satisfy.
//
// Positions are shared by all triangles around a vertex. Normals are indexed separately, so a sharp seam needs no
// second vertex. Triangles run counter-clockwise seen from outside.
#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "bounds/vec.hpp"

namespace deburr {

/// A triangle: indices in Mesh::positions and Mesh::normals, and the numbers of its material and solid in the scene.
struct Triangle {
    std::array<int, 3> vertex;
    std::array<int, 3> normal;
    int material = 0;
    int solid = 0;
};

/// The mesh. Lengths are the scene's.
struct Mesh {
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;  // unit, outward
    std::vector<Triangle> triangles;
    std::size_t polygons = 0;  // faces before they were cut into triangles

    std::array<Vec3, 3> corners(const Triangle& t) const {
        return {positions[t.vertex[0]], positions[t.vertex[1]], positions[t.vertex[2]]};
    }
    /// A vector along the outward normal whose length is twice the triangle's area.
    Vec3 area_vector(const Triangle& t) const {
        const Vec3 a = positions[t.vertex[0]];
        return glm::cross(positions[t.vertex[1]] - a, positions[t.vertex[2]] - a);
    }
    /// Appends the other mesh's vertices, normals and triangles, with all triangles assigned to `solid`.
    void append(const Mesh& other, int solid);
};

/// Counts of a mesh's elements and of its topological faults.
struct Topology {
    std::size_t vertices = 0, edges = 0, triangles = 0;  // only vertices in use
    std::size_t open_edges = 0;                          // edges of one triangle only
    std::size_t nonmanifold_edges = 0;                   // edges of more than two triangles
    std::size_t flipped_edges = 0;         // edges that both of their triangles run through in the same direction
    std::size_t nonmanifold_vertices = 0;  // vertices whose triangles are not a single fan
    std::size_t shells = 0;                // connected components
    long euler = 0;                        // vertices − edges + triangles

    bool closed() const { return open_edges == 0 && nonmanifold_edges == 0; }
    bool manifold() const { return closed() && flipped_edges == 0 && nonmanifold_vertices == 0; }
};

/// Counts the mesh's elements and faults.
Topology topology(const Mesh& mesh);

/// The box around all positions; empty for an empty mesh.
Box bounding_box(const Mesh& mesh);
/// The box around one triangle of the mesh.
Box bounding_box(const Mesh& mesh, const Triangle& triangle);
/// The mean length of the edges of a closed mesh; 0 if it is empty.
double mean_edge(const Mesh& mesh);
/// A box slightly larger than the mesh, for a DistanceField of the surfaces near it.
Box field_box(const Mesh& mesh);

/// The enclosed volume; positive if triangles face outward.
double volume(const Mesh& mesh);

}  // namespace deburr
