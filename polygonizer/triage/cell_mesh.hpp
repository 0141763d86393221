// The cells of a subdivision as closed convex meshes, for pictures of it [Triage, figures 4, 8, 13].
#pragma once
#include "polygonizer/mesh/mesh.hpp"
#include "polygonizer/triage/density_class.hpp"
#include "polygonizer/triage/subdivision.hpp"

namespace deburr {

/// Flat-shaded. About its middle the cell is scaled by `scale`, and then moved by `offset`.
Mesh cell_mesh(const CellComplex& complex, int cell, double scale = 1, Vec3 offset = Vec3(0.0));

/// The mean of the cell's vertices.
Vec3 cell_middle(const CellComplex& complex, int cell);

/// The density class of a cell with respect to one leaf [Triage §4.2.1]: unclassified where the leaf
/// straddles, else by ρ over the cell.
DensityClass cell_class(const Subdivision& subdivision, int cell, int leaf, const DensityTree& density);

}  // namespace deburr
