// Splits an edge of a mesh by a vertex where the surfaces of its two facets meet.
#pragma once
#include "polygonizer/mesh/facet_judge.hpp"

namespace deburr {

/// The surface that a facet stands for: its leaf's isosurface, or its plane.
LeafSurface surface_of(const Facets& facets, const Facet& facet);

/// Adds a surface to the pieces unless it is among them.
void add_surface(std::vector<LeafSurface>& pieces, const LeafSurface& piece);

/// The change that puts a vertex on edge k of facet f, at the fraction `share` of the edge and then moved onto the
/// surfaces of both facets. None if these surfaces do not meet near there, or not on the solid. The vertex and its
/// normals are added to `facets` even if the change is not applied.
std::optional<Change> split_on_surface(Facets& facets, const FacetJudge& judge, int f, std::size_t k,
                                       double share = 0.5);

}  // namespace deburr
