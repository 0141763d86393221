// Marching Cubes [Lorensen & Cline 1987], the peer that the paper measures triage against
// [Triage §6.2].
//
// The cases are not tabled but traced: every face of a cube joins its sign changes by itself, and a
// face with four is decided by the saddle of the bilinear interpolant of its corners (Nielson &
// Hamann 1991). Both cubes at a face see the same four values, so the mesh is closed.
#pragma once
#include "bounds/solid_tree.hpp"
#include "polygonizer/mesh/cancel.hpp"
#include "polygonizer/mesh/mesh.hpp"
#include "polygonizer/mesh/work_progress.hpp"

namespace deburr {

/// Side of a cube as in [Triage §6.2]: half the least rounding radius; of a sharp solid a hundredth
/// of the box.
double marching_cubes_grid(const SolidTree& solid, const Box& box);

/// How many cubes that makes.
double marching_cubes_count(const Box& box, double grid);

/// A closed mesh. What leaves `box` is cut off by it. Vertices are roots, not interpolated. Throws Cancelled.
Mesh marching_cubes(const SolidTree& solid, const Box& box, double grid, CancelFlag cancel = nullptr,
                    WorkProgress* progress = nullptr);

}  // namespace deburr
