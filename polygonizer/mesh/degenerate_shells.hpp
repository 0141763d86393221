// Shells of a mesh that bound nothing of the solid: what is left where parts of it only touch, or surfaces
// coincide.
#pragma once
#include "polygonizer/mesh/facets.hpp"
#include "polygonizer/mesh/surface_distance.hpp"

namespace deburr {

/// Drops shells that enclose less than `thickness` times their area, and thin ones without anything of the
/// solid within. `origins`, one for each triangle, goes along. Returns how many triangles went.
std::size_t drop_flat_shells(Mesh& mesh, std::vector<Origin>& origins, double thickness, const DistanceField& solid);

/// Drops thin shells that consist by half or more of triangles that are `wrong`, which are numbered anew, or have one
/// and normals that all face the same way: no part of the solid's surface is like that, but chords of surfaces that
/// coincide are, each time they cross, and four chords of one sheet.
std::size_t drop_wrong_shells(Mesh& mesh, std::vector<Origin>& origins, std::vector<int>& wrong);

}  // namespace deburr
