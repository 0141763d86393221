// Triage polygonization of a solid [Triage].
#pragma once
#include "bounds/solid_tree.hpp"
#include "polygonizer/mesh/cancel.hpp"
#include "polygonizer/mesh/mesh.hpp"
#include "polygonizer/mesh/work_progress.hpp"
#include "polygonizer/triage/subdivision.hpp"

namespace deburr {

struct TriageOptions {
    /// Largest distance between mesh and surface that is accepted; infinity: the paper's one
    /// refinement of each edge.
    double tolerance = infinity;
    /// Whether a mesh with a tolerance is thinned out within it. Pictures of meshes want its normals dense instead.
    bool decimate = true;
    /// Looked at between the rounds of refinement.
    CancelFlag cancel = nullptr;
    /// Half-spaces that may be left in open cells.
    std::size_t max_half_spaces = SubdivisionOptions{}.max_half_spaces;
    /// Told how far the work is; it is never finished here. Null: nobody asks.
    WorkProgress* progress = nullptr;
};

struct TriageStatistics {
    std::size_t cells = 0, open_cells = 0;  // open: polygonized by subspace polygonization
    std::size_t rounds = 1;                 // of refinement
};

/// A closed, oriented 2-manifold mesh of the solid. What leaves `box` is cut off by it. Throws Cancelled, and
/// TooManyCells.
Mesh triage(const SolidTree& solid, const Box& box, const TriageOptions& options = {},
            TriageStatistics* statistics = nullptr);

/// The box to polygonize a solid in: around it, with a margin; infinite sides are brought to
/// finite ones.
Box polygonization_box(const SolidTree& solid);

}  // namespace deburr
