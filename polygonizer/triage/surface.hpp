// The mesh between the cells inside and the cells outside [Triage §4.3, tree polygons and subspace
// polygons alike].
//
// Around every edge the polygons that bound one wedge of the solid are joined, and a mesh vertex is
// a cycle of polygon corners joined that way. So the mesh is a 2-manifold even where the solid
// touches itself along an edge or in a point: it has separate vertices there, in one place.
// Flat polygons of one plane are joined, whatever cut them apart.
#pragma once
#include "polygonizer/mesh/facets.hpp"
#include "polygonizer/triage/subspace.hpp"

namespace deburr {

/// `origins`, if given, gets one for each triangle. Where only some cells were polygonized, walls close the mesh beside
/// the others, of triangles whose origin is `Origin::wall`.
Mesh surface(const Subspace& subspace, const SolidTree& solid, std::vector<Origin>* origins = nullptr);

}  // namespace deburr
