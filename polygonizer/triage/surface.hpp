// Extracts the mesh between cells inside and cells outside [Triage §4.3, tree polygons and subspace polygons alike].
//
// Around every edge the polygons that bound one wedge of the solid are joined, and a mesh vertex is a cycle of polygon
// corners joined that way. So the mesh is a 2-manifold even where the solid touches itself along an edge or at a point:
// there are separate vertices in one place. Flat polygons of one plane are merged, whatever cut them apart.
#pragma once
#include "polygonizer/mesh/facets.hpp"
#include "polygonizer/triage/subspace.hpp"

namespace deburr {

/// The mesh of a polygonized subspace. `origins`, if given, must be empty and gets one for each triangle. If only some
/// cells were polygonized, walls close the mesh beside the others; the origin of their triangles has the leaf
/// Origin::wall.
Mesh surface(const Subspace& subspace, const SolidTree& solid, std::vector<Origin>* origins = nullptr);

}  // namespace deburr
