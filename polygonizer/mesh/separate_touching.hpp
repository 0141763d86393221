// Parts of a mesh that touch have separate vertices in one place. A reader that joins vertices by position, as readers
// of STL must, would make edges of four triangles there. So such vertices are moved into their own parts by a tiny
// distance. Vertices of one part that are too near to each other to be distinguished become one.
#pragma once
#include "polygonizer/mesh/facets.hpp"

namespace deburr {

/// The tiny distance; it keeps vertices within 10⁻⁶ of the surface.
constexpr double min_separation = 4e-7;

/// A distance that single precision can still represent at this mesh's coordinates; at least min_separation.
double single_precision_step(const Mesh& mesh);

/// Collapses edges whose ends have the same position in single precision, where the mesh stays a 2-manifold, and edges
/// no longer than a few steps of single precision where all facets keep facing as their corners' normals do. Returns
/// the number of vertices removed.
std::size_t merge_close(Mesh& mesh);

/// Moves vertices whose positions are equal in single precision inward by `step`, or by less where their triangles are
/// small, until they differ. Returns the number of vertices that still do not.
std::size_t separate_touching(Mesh& mesh, double step = min_separation);

}  // namespace deburr
