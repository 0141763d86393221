// Triangles as a file has them: which corners are one, which triangles one too many, and how they hang together.
#pragma once
#include <vector>

#include "bounds/closed_mesh.hpp"
#include "raytracer/model/model_module.hpp"

namespace deburr {

struct FileSurface {
    std::vector<Vec3> vertices;
    std::vector<ClosedMesh::Corners> triangles;
};

/// Vertices that are equal are one, in the order in which the file has them, so that equal files give equal meshes
/// whatever their vertices' values.
FileSurface welded(const TriangleSoup& soup);

/// Drops triangles of which two corners are one.
void drop_collapsed(FileSurface& surface);

/// Equal triangles count once, and a pair back to back not at all. Returns how many went.
std::size_t drop_doubles(FileSurface& surface);

/// Edges at which a surface does not close.
struct Openness {
    std::size_t open = 0;      // edges with an odd number of triangles
    std::size_t unturned = 0;  // even, but not as many one way as the other
    Vec3 place{0.0};           // of the first open one
    std::vector<int> rim;      // vertices of open edges
};

Openness openness(const FileSurface& surface);

/// Joins vertices of open edges that are within `distance` of one another.
void weld_rim(FileSurface& surface, const std::vector<int>& rim, double distance);

/// The shell of each triangle, and the number of shells: triangles that hang together by edges that two of them share.
std::vector<int> shells_of(const FileSurface& surface, int& count);

/// Turns triangles so that neighbours agree; returns how many, or −1 where a shell has one side only.
long turn_alike(FileSurface& surface);

}  // namespace deburr
