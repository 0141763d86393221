// Whether a mesh is what it should be: closed, facing outward, crossing itself nowhere, and around just those
// points that the solid holds.
//
// Points are taken where mistakes show: on either side of facets, and in the parts of a box around the solid that no
// facet passes, which are cut until the solid is known there. Facets that reach into each other by no more than
// rounding do not cross. What is found is so; that nothing is found proves
// nothing of parts smaller than the tolerance.
#pragma once
#include "bounds/solid_tree.hpp"
#include "polygonizer/mesh/cancel.hpp"
#include "polygonizer/mesh/mesh.hpp"

namespace deburr {

struct MeshCheckOptions {
    /// Points nearer to the solid's surface may be on either side of the mesh. Infinity: half of the filter radius
    /// there, and parts that have no facet within a radius are missed.
    double tolerance = infinity;
    double min_tolerance = 0;  // for what the mesh cannot be finer than
    /// Facets may face inward where the tolerance cannot tell: those of marching cubes do, in cubes that a thin wall
    /// passes.
    bool may_lean = false;
    CancelFlag cancel = nullptr;
};

/// Faults of one kind: how many there are, and the first of them.
struct MeshFault {
    std::size_t count = 0;
    Vec3 location{0.0};
    int line = 0;  // of the scene, which wrote the part of the solid that is near; 0 unknown

    void add(Vec3 x) {
        if (count++ == 0) location = x;
    }
};

struct MeshCheck {
    MeshFault open;                                 // edges that are not in two facets, once in each direction
    MeshFault inward;                               // facets
    MeshFault crossing;                             // pairs of facets
    MeshFault missing;                              // points that the solid holds, and the mesh does not
    MeshFault added;                                // points that the mesh holds, and the solid does not
    std::size_t facets = 0, pairs = 0, points = 0;  // that were looked at

    std::size_t faults() const { return open.count + inward.count + crossing.count + missing.count + added.count; }
};

/// `box`: around all that there is of the solid, or as far as it is wanted. Throws Cancelled.
MeshCheck check_mesh(const Mesh& mesh, const SolidTree& solid, const Box& box, const MeshCheckOptions& options = {});

}  // namespace deburr
