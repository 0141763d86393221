// Which side of each shell of a file's surface is the solid's.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "raytracer/model/file_surface.hpp"

namespace deburr {

/// Turns shells so that the solid is where it must be, and drops those around which it is already; `trusted`: what the
/// file says of the sides counts. Shells that cross at these pairs of triangles lie in each other no more than side by
/// side, and stay. Adds to `mended` what was done.
void settle_shells(FileSurface& surface, bool trusted, const std::vector<std::pair<int, int>>& crossing,
                   std::vector<std::string>& mended);

}  // namespace deburr
