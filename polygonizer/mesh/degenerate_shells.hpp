// Drops shells of a mesh that bound no part of the solid: remains where parts of the solid only touch, or surfaces
// coincide.
#pragma once
#include "polygonizer/mesh/facets.hpp"
#include "polygonizer/mesh/surface_distance.hpp"

namespace deburr {

/// Drops shells whose volume is less than `thickness` times their area, and thin ones that hold nothing of the solid.
/// `origins`, one for each triangle, is updated. Returns the number of triangles dropped.
std::size_t drop_flat_shells(Mesh& mesh, std::vector<Origin>& origins, double thickness, const DistanceField& solid);

/// Drops thin shells of which at least half of the triangles are `wrong`, or that have a wrong triangle and corner
/// normals that all face the same way. No part of a solid's surface is like that, but chords of surfaces that coincide
/// are, each time they cross, and so are four chords of one sheet. `wrong` is renumbered. Returns the number of
/// triangles dropped.
std::size_t drop_wrong_shells(Mesh& mesh, std::vector<Origin>& origins, std::vector<int>& wrong);

}  // namespace deburr
