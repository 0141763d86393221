// Polygonization by an octree [Vyatkin §3.2–3.4]: of free forms, of rounded polyhedra, and of what
// CSG makes of them.
//
// Cells where the surface may be (octree_cells), points on it (octree_points), quadrilaterals between
// neighbours and triangles from these (octree_linking), hard edges divided to the wanted length
// (octree_hard_edges).
//
// Promised: a closed, oriented 2-manifold whose vertices lie on the surface. Not promised: parts of
// free forms that are thinner than a quarter of a cell (of a form that no cell sees: than a
// sixteenth), and of polyhedra than a cell.
//
// Printed differently: all of the paper's cells are of the smallest size. Here those around a
// triangle that leans too far from the surface, or is farther from it than asked, are cut further,
// and so are those that a free form's surface passes between their corners.
#pragma once
#include <stdexcept>

#include "bounds/solid_tree.hpp"
#include "polygonizer/mesh/cancel.hpp"
#include "polygonizer/mesh/mesh.hpp"
#include "polygonizer/mesh/work_progress.hpp"

namespace deburr {

struct OctreeOptions {
    double edge = 0;  // side of a cell, which is nearly the mean length of edges; 0: octree_edge()
    /// Degrees between faces from which on their edge is kept. Printed differently: 45, at which the
    /// edges of an octagon are lost; it costs nothing to keep them.
    double hard_angle = 15;
    double tolerance = infinity;               // largest distance of a triangle's middle from the surface
    bool decimate = false;                     // a mesh with a tolerance is thinned out within it
    std::size_t max_open_cells = 100'000'000;  // that the surface may pass
    CancelFlag cancel = nullptr;
    WorkProgress* progress = nullptr;  // told how far the work is; it is never finished here
};

struct OctreeStatistics {
    int level = 0;  // 2^level cells across the root
    double edge = 0;
    std::size_t range_tests = 0, cells = 0, open_cells = 0;  // of the smallest cells, may the surface pass
    std::size_t hard_points = 0, partitions = 0;             // on hard edges; edges of these that were divided
    std::size_t rounds = 0;                                  // of cutting further
};

/// A mesh that did not close, and where.
struct OpenMeshError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Side of a cell by default: half the least radius, within 1/64 and 1/512 of the box.
double octree_edge(const SolidTree& solid, const Box& box);

/// Throws what octree() would throw of the cells that it begins with, at a part of the cost.
void check_octree_cells(const SolidTree& solid, const Box& box, const OctreeOptions& options);

/// The mesh of the solid's part within `box`. Throws OpenMeshError; std::length_error if `edge`
/// and `tolerance` make too many cells; and Cancelled.
Mesh octree(const SolidTree& solid, const Box& box, const OctreeOptions& options = {},
            OctreeStatistics* statistics = nullptr);

}  // namespace deburr
