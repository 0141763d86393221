// Checks that a mesh is closed, faces outward, does not cross itself, and encloses just the points of the solid.
//
// Points are tested where mistakes show: on both sides of facets, and in those parts of a box around the solid that no
// facet passes; parts are halved until the solid is known there. Facets that reach into each other by no more than
// rounding do not cross. Faults that are reported are real; that none is reported proves nothing about parts smaller
// than the tolerance.
#pragma once
#include "bounds/solid_tree.hpp"
#include "polygonizer/mesh/cancel.hpp"
#include "polygonizer/mesh/mesh.hpp"

namespace deburr {

/// Lengths are the scene's.
struct MeshCheckOptions {
    /// Points nearer to the solid's surface than this may be on either side of the mesh. Infinity stands for half of
    /// the greatest filter radius; then parts of the solid that have no facet within a radius are reported as missing,
    /// too.
    double tolerance = infinity;
    double min_tolerance = 0;  // lower limit of the tolerance, below which the mesh cannot be
    /// Does not report facets that face inward, as those of marching cubes do in cubes that a thin wall passes. Points
    /// beside such facets are tested all the same.
    bool may_lean = false;
    CancelFlag cancel = nullptr;
};

/// Faults of one kind: their number, and the location of the first.
struct MeshFault {
    std::size_t count = 0;
    Vec3 location{0.0};
    int line = 0;  // line of the scene that wrote the nearest part of the solid; 0 unknown

    void add(Vec3 x) {
        if (count++ == 0) location = x;
    }
};

/// The faults of a mesh, and how much was examined.
struct MeshCheck {
    MeshFault open;                                 // edges that are not in exactly two facets, once in each direction
    MeshFault inward;                               // facets that face inward
    MeshFault crossing;                             // pairs of facets that cross
    MeshFault missing;                              // points inside the solid and outside of the mesh
    MeshFault added;                                // points inside the mesh and outside of the solid
    std::size_t facets = 0, pairs = 0, points = 0;  // numbers of facets, pairs of facets and points that were examined

    std::size_t faults() const { return open.count + inward.count + crossing.count + missing.count + added.count; }
};

/// Checks the mesh of a solid. `box` holds the whole solid, or the part of it that was meshed. Throws Cancelled.
MeshCheck check_mesh(const Mesh& mesh, const SolidTree& solid, const Box& box, const MeshCheckOptions& options = {});

}  // namespace deburr
