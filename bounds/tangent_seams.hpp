// Finds tangent seams: places where a round part continues smoothly into another surface, such as a box into a
// half-cylinder, a rod into its hemisphere, a wall into the fillet that the outside of a rod leaves.
//
// Each of the two surfaces has a random draw of its own, so the solid bulges there by up to 0.28 r, as Lobb's product
// of two equal planes does [docs/design.md, Round primitives].
#pragma once
#include <vector>

#include "bounds/density_tree.hpp"

namespace deburr {

/// A seam between two parts, at the point where it bulges most clearly.
struct TangentSeam {
    Vec3 at;           // a point of both surfaces
    double bulge = 0;  // distance of the solid's surface from `at`, on either side; a world distance
    /// The lesser filter radius of the two parts.
    double radius = 0;
};

/// The seams of a density with round parts, one for each pair of parts whose surfaces touch on the solid's surface.
/// Parts are planes, spheres, cylinders, cones and tori in any position. At most `max_pairs` pairs are examined; bulges
/// of less than 0.02 radii are left out.
std::vector<TangentSeam> tangent_seams(const DensityTree& tree, int max_pairs = 20'000);

}  // namespace deburr
