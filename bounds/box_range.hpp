// The range of a density over a box, and the local density that is left of it there.
//
// Interval arithmetic says for each half-space whether its density is 0, 1 or varying over the
// box, and for the tree whether it is outside, inside or straddling. What is left is the local
// density [Triage §4.2.1, §4.5.1]. Conjunctions and disjunctions take the Fréchet bounds, which
// hold whatever their operands share.
//
// Not promised: that a range is the tightest one.
#pragma once
#include <algorithm>
#include <span>

#include "bounds/density_tree.hpp"

namespace deburr {

/// Range of op(a, b) from the ranges of a and b, valid whatever half-spaces a and b share. A complement ignores b.
inline Range combine(Op op, Range a, Range b) {
    switch (op) {
        case Op::sum: return {a.lo + b.lo, a.hi + b.hi};
        case Op::product: {
            if (a.lo >= 0 && b.lo >= 0) return {a.lo * b.lo, a.hi * b.hi};
            const auto [lo, hi] = std::minmax({a.lo * b.lo, a.lo * b.hi, a.hi * b.lo, a.hi * b.hi});
            return {lo, hi};
        }
        case Op::difference: return {a.lo - b.hi, a.hi - b.lo};
        case Op::complement: return {1 - a.hi, 1 - a.lo};
        case Op::conjunction: return {std::max(0.0, a.lo + b.lo - 1), std::min(a.hi, b.hi)};
        case Op::disjunction: return {std::max(a.lo, b.lo), std::min(1.0, a.hi + b.hi)};
        default: return a;
    }
}

/// A range that holds n·x − offset, or u(x) − offset of a round part, over the box (a world distance); exact for planes
/// up to rounding. The box may have infinite sides.
Range distance_range(const HalfSpace& h, const Box& box);

/// Range of the density of one half-space over the box.
Range density_range(const HalfSpace& h, const Box& box);

/// Range of ρ over the box.
Range density_range(const DensityTree& tree, const Box& box);

/// True if every operand of the papers' arithmetic provably lies in [0, 1] over the box; false says nothing.
bool bounds_hold(const DensityTree& tree, const Box& box);

enum class Side { outside, inside, straddling };

/// Range of ρ over any region, given the range of each half-space's density over it: half_spaces[i] belongs to
/// tree.half_spaces[i]. Supports are not used.
Range density_range(const DensityTree& tree, const std::vector<Range>& half_spaces);

/// Where a box lies with respect to the set ρ > ½, as far as the range of ρ over it can tell.
inline Side classify(Range rho) {
    if (rho.hi <= 0.5) return Side::outside;
    if (rho.lo > 0.5) return Side::inside;
    return Side::straddling;
}

/// Where a box lies with respect to a field's set f > 0, given the range of f over it.
inline Side classify_field(Range f) {
    if (f.hi <= 0) return Side::outside;
    if (f.lo > 0) return Side::inside;
    return Side::straddling;
}

struct Pruned {
    DensityTree tree;  // equals the original throughout the region
    Range range;       // of ρ over the region
};

/// The local density of the box: the tree with every part that is constant there folded away.
Pruned prune(const DensityTree& tree, const Box& box);

/// The local density of any region, given the range of each half-space's density over it (as in density_range).
Pruned prune(const DensityTree& tree, const std::vector<Range>& half_spaces);

/// Like prune(), but returns a tree without nodes where copying does not pay: where is_classified(range) is true, where
/// no half-space is folded away, or where more than 512 are left and those are more than three quarters.
Pruned prune_further(const DensityTree& tree, const std::vector<Range>& half_spaces, bool (&is_classified)(Range));

/// The range of ρ, and how many half-spaces prune() would leave.
struct LocalSize {
    Range range;
    int half_spaces = 0;
};

/// The range of ρ over the box and the size of its local density, at less cost than prune().
LocalSize local_size(const DensityTree& tree, const Box& box);

/// local_size() in several boxes, with one walk over the tree for every four of them; sizes[k] is set for boxes[k], so
/// `sizes` has room for as many.
void local_sizes(const DensityTree& tree, std::span<const Box> boxes, LocalSize* sizes);

}  // namespace deburr
