// Bounding boxes of densities and solids, found from their outer bound CSG.
//
// Lobb tags convex intersections as boundable and takes their vertices [Lobb §3.5]. Here every
// intersection of planes is bounded by linear programs (polyhedron_box.hpp), and the rest follows by
// interval arithmetic on boxes. Sides may be infinite.
#pragma once
#include "bounds/csg_bounds.hpp"
#include "bounds/solid_tree.hpp"

namespace deburr {

/// A box that holds the CSG object; empty if the object is certainly empty.
Box bounding_box(const BoundCsg& csg);
/// A box that holds the set ρ > ½: that of the outer bound where operands are in [0, 1] (bounds_hold), else the support
/// of the root. Sides may be infinite.
Box bounding_box(const DensityTree& tree);
/// A box that holds the solid. Sides may be infinite.
Box bounding_box(const SolidTree& tree);

}  // namespace deburr
