// Whether the papers' sums and differences stay in [0, 1] [Lobb §2.2, §4.2].
//
// Lobb leaves it to the modeller that summands are disjoint and that subtracted parts lie inside; otherwise ρ leaves
// [0, 1] and surfaces escape the bounds. Here boxes are halved where the range of ρ may leave [0, 1], and a point where
// ρ does is the proof. Products of legal densities and Boolean densities are always legal.
//
// Not promised: that every illegal density is found. A search that has spent its effort has merely found nothing.
#pragma once
#include <cstdint>
#include <limits>
#include <vector>

#include "bounds/density_tree.hpp"

namespace deburr {

/// A sum or difference that leaves [0, 1], and the worst point that was found.
struct IllegalDensity {
    Op op = Op::sum;  // sum or difference
    int line = 0;     // line of the scene, 0 unknown
    Vec3 point{0.0};
    double value = 0;  // ρ at `point`, outside of [0, 1]
};

/// The effort of a search: at most `boxes` boxes for each operator, and at most `nodes` tree nodes in all, which are
/// shared evenly among operators. `nodes` is counted down; operators that are left when it is spent are not searched.
struct LegalityEffort {
    int boxes = 0;
    std::int64_t nodes = std::numeric_limits<std::int64_t>::max();
};

/// The sums and differences of the tree that leave [0, 1] by more than 10⁻⁶: for each operator and line of the scene
/// the worst point that was found.
std::vector<IllegalDensity> find_illegal(const DensityTree& tree, LegalityEffort& effort);
inline std::vector<IllegalDensity> find_illegal(const DensityTree& tree, int boxes) {
    LegalityEffort effort{boxes};
    return find_illegal(tree, effort);
}

}  // namespace deburr
