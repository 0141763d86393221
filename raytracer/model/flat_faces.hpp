// Makes faces flat again that were flat before a file rounded their vertices to single precision.
#pragma once
#include <array>
#include <vector>

#include "bounds/vec.hpp"

namespace deburr {

/// Moves the vertices of a closed surface onto the planes of the faces around them. A face is a set of neighbouring
/// triangles whose corners are within a few units in the last place of a float of one plane. No vertex moves farther
/// than that.
void flatten_faces(std::vector<Vec3>& vertices, const std::vector<std::array<int, 3>>& triangles);

}  // namespace deburr
