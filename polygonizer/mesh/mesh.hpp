// A triangle mesh with shared vertices, and what a closed surface has to satisfy.
//
// Positions are shared by all triangles around a vertex; normals are indexed apart, so that a sharp
// seam needs no second vertex. Triangles are counter-clockwise seen from outside.
#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "bounds/vec.hpp"

namespace deburr {

struct Triangle {
    std::array<int, 3> vertex;
    std::array<int, 3> normal;
    int material = 0;
    int solid = 0;
};

struct Mesh {
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;  // unit, outward
    std::vector<Triangle> triangles;
    std::size_t polygons = 0;  // faces before they were cut into triangles

    /// Twice the area, outward.
    Vec3 area_vector(const Triangle& t) const {
        const Vec3 a = positions[t.vertex[0]];
        return glm::cross(positions[t.vertex[1]] - a, positions[t.vertex[2]] - a);
    }
    void append(const Mesh& other, int solid);
};

struct Topology {
    std::size_t vertices = 0, edges = 0, triangles = 0;  // vertices in use
    std::size_t open_edges = 0;                          // in one triangle only
    std::size_t nonmanifold_edges = 0;                   // in more than two
    std::size_t flipped_edges = 0;                       // run through in one direction by both triangles
    std::size_t nonmanifold_vertices = 0;                // whose triangles are not one fan
    std::size_t shells = 0;                              // connected components
    long euler = 0;                                      // vertices − edges + triangles

    bool closed() const { return open_edges == 0 && nonmanifold_edges == 0; }
    bool manifold() const { return closed() && flipped_edges == 0 && nonmanifold_vertices == 0; }
};

Topology topology(const Mesh& mesh);

Box bounding_box(const Mesh& mesh);
/// Box around one triangle, whose vertices are the mesh's.
Box bounding_box(const Mesh& mesh, const Triangle& triangle);
/// Length of an edge of the closed mesh; 0 if it is empty.
double mean_edge(const Mesh& mesh);
/// A box around the mesh in which to look for the surfaces near it (DistanceField).
Box field_box(const Mesh& mesh);

/// Volume enclosed; positive where triangles face outward.
double volume(const Mesh& mesh);

}  // namespace deburr
