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
#include <cstdint>
#include <limits>
#include <vector>

#include "bounds/density_tree.hpp"

namespace deburr {

struct IllegalDensity {
    Op op = Op::sum;  // or difference
    int line = 0;     // place in the scene, 0 unknown
    Vec3 point{0.0};
    double value = 0;  // ρ there
};

/// How long to look: at so many boxes for each operator, and at so many tree nodes in all, which are shared
/// evenly. `nodes` is counted down; once it is spent, what is left of the operators is not looked at.
struct LegalityEffort {
    int boxes = 0;
    std::int64_t nodes = std::numeric_limits<std::int64_t>::max();
};

/// The sums and differences of the tree that leave [0, 1], the worst point found of each line.
std::vector<IllegalDensity> find_illegal(const DensityTree& tree, LegalityEffort& effort);
inline std::vector<IllegalDensity> find_illegal(const DensityTree& tree, int boxes) {
    LegalityEffort effort{boxes};
    return find_illegal(tree, effort);
}

}  // namespace deburr
