// Triage polygonization of a solid: planes cut space into cells, the isosurface cuts undecided cells, and the mesh
// between cells inside and outside is refined and mended [Triage].
#pragma once
#include "bounds/solid_tree.hpp"
#include "polygonizer/mesh/cancel.hpp"
#include "polygonizer/mesh/mesh.hpp"
#include "polygonizer/mesh/work_progress.hpp"
#include "polygonizer/triage/subdivision.hpp"

namespace deburr {

/// Settings of triage(). Lengths are the scene's.
struct TriageOptions {
    /// The greatest accepted distance between mesh and surface. Infinity: the paper's one refinement of each edge.
    double tolerance = infinity;
    /// Whether a mesh with a tolerance is decimated within it. Meshes for pictures need dense normals instead.
    bool decimate = true;
    /// Checked between and within rounds of refinement.
    CancelFlag cancel = nullptr;
    /// The greatest number of half-spaces in undecided cells.
    std::size_t max_half_spaces = SubdivisionOptions{}.max_half_spaces;
    /// Advanced by the work, never finished; may be null.
    WorkProgress* progress = nullptr;
};

/// How much work the mesh took.
struct TriageStatistics {
    std::size_t cells = 0, open_cells = 0;  // open cells are polygonized by the isosurface
    std::size_t rounds = 1;                 // rounds in which all cells were polygonized
};

/// A closed, oriented 2-manifold mesh of the part of the solid within `box`. Throws Cancelled and TooManyCells.
Mesh triage(const SolidTree& solid, const Box& box, const TriageOptions& options = {},
            TriageStatistics* statistics = nullptr);

/// The box in which to polygonize a solid: its bounding box with a margin, and infinite sides replaced by finite ones.
Box polygonization_box(const SolidTree& solid);

}  // namespace deburr
