// Marching cubes [Lorensen & Cline 1987], with which the paper compares triage [Triage §6.2].
//
// The cases are traced instead of tabled: every face of a cube joins its sign changes by itself, and on a face with
// four the saddle of the bilinear interpolant of its corners decides (Nielson & Hamann 1991). Both cubes at a face see
// the same four values, so the mesh is closed.
#pragma once
#include "bounds/solid_tree.hpp"
#include "polygonizer/mesh/cancel.hpp"
#include "polygonizer/mesh/mesh.hpp"
#include "polygonizer/mesh/work_progress.hpp"

namespace deburr {

/// The side of a cube as in [Triage §6.2]: half the least filter radius; for a sharp solid a hundredth of the box's
/// longest side.
double marching_cubes_grid(const SolidTree& solid, const Box& box);

/// About how many cubes of side `grid` the box takes.
double marching_cubes_count(const Box& box, double grid);

/// A closed mesh of the part of the solid within `box`; `grid` is the side of a cube. Vertices are roots, not
/// interpolated. Throws Cancelled.
Mesh marching_cubes(const SolidTree& solid, const Box& box, double grid, CancelFlag cancel = nullptr,
                    WorkProgress* progress = nullptr);

}  // namespace deburr
