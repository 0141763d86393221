// Places where a round part runs on smoothly into another surface: a box into a half-cylinder, a rod into its
// hemisphere, a wall into a fillet that a rod's outside leaves.
//
// Each of the two draws for itself, so the surface bulges there by up to 0.28 r, as Lobb's products of equal planes do
// [docs/design.md, Round primitives].
#pragma once
#include <vector>

#include "bounds/density_tree.hpp"

namespace deburr {

struct TangentSeam {
    Vec3 at;           // a point of both surfaces
    double bulge = 0;  // by how much the solid's surface lies beside it, in either direction
    double radius = 0;
};

/// One place for each pair of parts that touch along their surfaces, and on the solid's. Parts are planes, spheres,
/// cylinders, cones and tori, however they lie. At most `max_pairs` pairs are looked at.
std::vector<TangentSeam> tangent_seams(const DensityTree& tree, int max_pairs = 20'000);

}  // namespace deburr
