// Triangles as read from a file, as an indexed surface: joins vertices, drops duplicates, finds open edges and shells.
#pragma once
#include <vector>

#include "bounds/closed_mesh.hpp"
#include "raytracer/model/model_module.hpp"

namespace deburr {

/// An indexed triangle surface that need not be closed.
struct FileSurface {
    std::vector<Vec3> vertices;
    std::vector<ClosedMesh::Corners> triangles;
};

/// Joins vertices at equal positions. Vertices keep the file's order, so that the result does not depend on their
/// values.
FileSurface welded(const TriangleSoup& soup);

/// Drops triangles that have two equal corners.
void drop_collapsed(FileSurface& surface);

/// Keeps one of several equal triangles, and none of a pair of opposite ones. Returns how many were dropped.
std::size_t drop_doubles(FileSurface& surface);

/// The edges at which a surface is not closed.
struct Openness {
    std::size_t open = 0;      // number of edges with an odd number of triangles
    std::size_t unturned = 0;  // edges with an even number, but unequally many in each direction
    Vec3 place{0.0};           // middle of the first open edge
    std::vector<int> rim;      // vertices of open edges, sorted
};

Openness openness(const FileSurface& surface);

/// Joins vertices of `rim` that are within `distance` of each other.
void weld_rim(FileSurface& surface, const std::vector<int>& rim, double distance);

/// The shell of each triangle, and the number of shells: triangles are in one shell if they are connected by edges that
/// have exactly two triangles.
std::vector<int> shells_of(const FileSurface& surface, int& count);

/// Turns triangles so that neighbours have the same orientation. Returns how many were turned, or −1 if a shell is
/// one-sided.
long turn_alike(FileSurface& surface);

}  // namespace deburr
