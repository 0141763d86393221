// Faces that were flat before a file rounded their corners to single precision are made flat again.
#pragma once
#include <array>
#include <vector>

#include "bounds/vec.hpp"

namespace deburr {

/// Moves vertices of a closed surface onto the planes of the faces around them: neighbouring triangles whose corners
/// lie within a few units in the last place of a float of one plane are a face. No vertex moves farther than that.
void flatten_faces(std::vector<Vec3>& vertices, const std::vector<std::array<int, 3>>& triangles);

}  // namespace deburr
