// Whether the papers' sums and differences keep to [0, 1] [Lobb §2.2, §4.2].
//
// Lobb leaves it to the modeller that summed parts are disjoint and subtracted ones lie inside;
// otherwise ρ leaves [0, 1] and surfaces escape the bounds. Here boxes are halved where the range of
// ρ over them may leave [0, 1], and a point where it does is the proof. Products of legal densities
// and Boolean densities are legal always.
//
// Not promised: that every illegal density is found. A search that ends with its boxes spent has
// merely found nothing.
#pragma once
#include <vector>

#include "bounds/density_tree.hpp"

namespace deburr {

struct IllegalDensity {
    Op op = Op::sum;  // or difference
    int line = 0;     // place in the scene, 0 unknown
    Vec3 point{0.0};
    double value = 0;  // ρ there
};

/// The sums and differences of the tree that leave [0, 1], the worst point found of each line;
/// `boxes` at most are looked at for each.
std::vector<IllegalDensity> find_illegal(const DensityTree& tree, int boxes);

}  // namespace deburr
