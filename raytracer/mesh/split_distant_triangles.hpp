// Splits triangles that are large compared with their distance, so that they can be traced in single precision.
#pragma once
#include "bounds/vec.hpp"
#include "polygonizer/mesh/mesh.hpp"

namespace deburr {

/// Halves edges, with the triangles on both sides, until no edge is longer than the size of `near` plus the edge's
/// distance from its middle. The surface, its normals and its closedness do not change. A tilted floor that reaches the
/// horizon becomes a few hundred triangles, and the error of single precision is 10⁻⁷ of the distance from `near`
/// instead of the floor's size. Triangles perpendicular to an axis lose nothing and are not split.
Mesh split_distant_triangles(Mesh mesh, const Box& near);

}  // namespace deburr
