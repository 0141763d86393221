// Polygonization by an octree [Vyatkin §3.2–3.4], for all kinds of leaves: free forms, rounded polyhedra, meshes, and
// their CSG.
//
// The octree keeps cells that the surface may pass (octree_cells). Points are put on the surface in them
// (octree_points) and linked to quadrilaterals and triangles (octree_linking). Hard edges are followed and divided to
// the wanted length (octree_hard_edges).
//
// Promised: a closed, oriented 2-manifold whose vertices lie on the surface. Not promised: parts of free forms that are
// thinner than a quarter of a cell (than a sixteenth, of a form that no cell sees), and parts of polyhedra that are
// thinner than a cell.
//
// Printed differently: all of the paper's cells are of the smallest size. Here cells are cut further around a triangle
// that leans too far from the surface or is farther from it than the tolerance, and where a free form's surface passes
// between their corners.
#pragma once
#include <stdexcept>

#include "bounds/solid_tree.hpp"
#include "polygonizer/mesh/cancel.hpp"
#include "polygonizer/mesh/mesh.hpp"
#include "polygonizer/mesh/work_progress.hpp"

namespace deburr {

/// Settings. Lengths are the scene's.
struct OctreeOptions {
    double edge = 0;  // side of a cell, which is about the mean length of edges; 0: octree_edge()
    /// The least angle between faces, in degrees, at which their edge is kept. Printed differently: 45, at which the
    /// edges of an octagon are lost; keeping them costs nothing.
    double hard_angle = 15;
    double tolerance = infinity;               // greatest distance of a triangle's middle from the surface
    bool decimate = false;                     // if there is a tolerance, the mesh is decimated within it
    std::size_t max_open_cells = 100'000'000;  // limit of cells that the surface may pass
    CancelFlag cancel = nullptr;
    WorkProgress* progress = nullptr;  // advanced by the work, never finished
};

/// How much work the mesh took. Cells are leaves of the octree.
struct OctreeStatistics {
    int level = 0;  // 2^level cells of the side `edge` are as long as the root
    double edge = 0;
    std::size_t range_tests = 0, cells = 0, open_cells = 0;  // evaluations of a range; leaves; leaves that the surface
                                                             // may pass
    std::size_t hard_points = 0, partitions = 0;             // points on hard edges; hard edges that were divided
    std::size_t rounds = 0;  // rounds in which cells were linked; between them cells are cut further
};

/// Thrown for a mesh that is not closed; what() says where.
struct OpenMeshError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The default side of a cell: half the least filter radius, limited to between 1/512 and 1/64 of the box's longest
/// side.
double octree_edge(const SolidTree& solid, const Box& box);

/// Throws what octree() would throw for the cells that it begins with, at a part of its cost.
void check_octree_cells(const SolidTree& solid, const Box& box, const OctreeOptions& options);

/// The mesh of the part of the solid within `box`. Throws OpenMeshError; std::length_error if `edge` and `tolerance`
/// ask for too many cells; and Cancelled.
Mesh octree(const SolidTree& solid, const Box& box, const OctreeOptions& options = {},
            OctreeStatistics* statistics = nullptr);

}  // namespace deburr
