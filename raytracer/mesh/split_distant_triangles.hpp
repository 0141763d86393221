// Triangles no longer than they are far away, for tracing in single precision.
#pragma once
#include "bounds/vec.hpp"
#include "polygonizer/mesh/mesh.hpp"

namespace deburr {

/// Halves edges that are longer than `near` and their distance from its middle together, with the
/// triangles on both their sides, until none is left: the surface, its normals and its closedness
/// stay. A tilted floor that reaches the horizon becomes some hundred triangles, and what single
/// precision loses is 10⁻⁷ of the distance from `near`, no longer of the floor's size. Triangles
/// across an axis lose nothing and are left alone.
Mesh split_distant_triangles(Mesh mesh, const Box& near);

}  // namespace deburr
