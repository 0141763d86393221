// Cells of a subdivision as closed convex meshes, for pictures [Triage, figures 4, 8, 13].
#pragma once
#include "polygonizer/mesh/mesh.hpp"
#include "polygonizer/triage/density_class.hpp"
#include "polygonizer/triage/subdivision.hpp"

namespace deburr {

/// The cell as a flat-shaded mesh, scaled about its middle by `scale` and then moved by `offset`.
Mesh cell_mesh(const CellComplex& complex, int cell, double scale = 1, Vec3 offset = Vec3(0.0));

/// The mean of the cell's vertices.
Vec3 cell_middle(const CellComplex& complex, int cell);

/// The density class of a cell with respect to a leaf, whose density is `density` [Triage §4.2.1]: unclassified if the
/// leaf straddles the cell, else by the range of ρ over the cell.
DensityClass cell_class(const Subdivision& subdivision, int cell, int leaf, const DensityTree& density);

}  // namespace deburr
