// Decides for each shell of a file's surface which side of it is solid.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "raytracer/model/file_surface.hpp"

namespace deburr {

/// Turns shells so that they bound the solid, and drops shells around which the solid is already. `trusted` says
/// whether the orientations in the file are used. `crossing` lists pairs of triangles that cross; shells with such
/// pairs are not taken as nested, and stay. Appends the repairs to `mended`.
void settle_shells(FileSurface& surface, bool trusted, const std::vector<std::pair<int, int>>& crossing,
                   std::vector<std::string>& mended);

}  // namespace deburr
