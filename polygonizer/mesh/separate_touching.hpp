// Parts of a mesh that touch have separate vertices in one place. A reader that joins vertices by
// their positions, as readers of STL have to, would make edges of four triangles of them. So each is
// moved by a hair into its own part. Vertices of one part that are too near to each other to be told
// apart become one.
#pragma once
#include "polygonizer/mesh/facets.hpp"

namespace deburr {

/// The hair: the vertices stay within 10⁻⁶ of the surface.
constexpr double min_separation = 4e-7;

/// A step that single precision still tells apart at this mesh's coordinates; at least a hair.
double single_precision_step(const Mesh& mesh);

/// Collapses edges whose ends have one position in single precision, where that leaves a 2-manifold, and those of a few
/// of its steps where all facets go on to face as their corners' normals do.
/// Returns how many went.
std::size_t merge_close(Mesh& mesh);

/// Moves vertices whose positions are the same in single precision inward by `step`, or by less
/// where their triangles are small, until they differ. Returns how many are left that do not.
std::size_t separate_touching(Mesh& mesh, double step = min_separation);

}  // namespace deburr
