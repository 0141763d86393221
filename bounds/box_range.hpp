// What a density can be over a box, and the little of it that matters there.
//
// Interval arithmetic says for each half-space whether its density is 0, 1 or varying over the
// box, and for the tree whether it is outside, inside or straddling. What is left is the local
// density [Triage §4.2.1, §4.5.1]. Conjunctions and disjunctions take the Fréchet bounds, which
// hold whatever their operands share.
//
// Not promised: that a range is the tightest.
#pragma once
#include <algorithm>
#include <span>

#include "bounds/density_tree.hpp"

namespace deburr {

/// Range of op(a, b) from the ranges of a and b, whatever half-spaces a and b share; a complement has no b.
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

/// Least and greatest n·x − offset over the box, or what holds them for a round part; infinite sides are allowed.
Range distance_range(const HalfSpace& h, const Box& box);

/// ρ of one half-space over the box.
Range density_range(const HalfSpace& h, const Box& box);

/// ρ of the tree over the box.
Range density_range(const DensityTree& tree, const Box& box);

/// True if every operand of the papers' arithmetic is provably in [0, 1] over the box; false says
/// nothing.
bool bounds_hold(const DensityTree& tree, const Box& box);

enum class Side { outside, inside, straddling };

/// Range of ρ over any region, given the range of every half-space's density over it.
Range density_range(const DensityTree& tree, const std::vector<Range>& half_spaces);

/// Where the box lies with respect to the set ρ > ½, as far as the range can tell.
inline Side classify(Range rho) {
    if (rho.hi <= 0.5) return Side::outside;
    if (rho.lo > 0.5) return Side::inside;
    return Side::straddling;
}

/// Where the box lies with respect to a field's set f > 0, given the range of f over the box.
inline Side classify_field(Range f) {
    if (f.hi <= 0) return Side::outside;
    if (f.lo > 0) return Side::inside;
    return Side::straddling;
}

struct Pruned {
    DensityTree tree;  // equals the original throughout the box
    Range range;       // of ρ over the box
};

/// The local density of the box: half-spaces that are constant there are folded away.
Pruned prune(const DensityTree& tree, const Box& box);

/// The local density of any region, given the range of every half-space's density over it.
Pruned prune(const DensityTree& tree, const std::vector<Range>& half_spaces);

/// prune(), but that the tree has no nodes unless it has fewer half-spaces than before (of hundreds a quarter less)
/// and is_classified(range) is false.
Pruned prune_further(const DensityTree& tree, const std::vector<Range>& half_spaces, bool (&is_classified)(Range));

struct LocalSize {
    Range range;
    int half_spaces = 0;  // that `prune` would leave
};

/// Range over the box, and how many half-spaces `prune` would leave; costs less than `prune`.
LocalSize local_size(const DensityTree& tree, const Box& box);

/// local_size in several boxes, by one walk over the tree for every four of them; sizes[k] is that of boxes[k].
void local_sizes(const DensityTree& tree, std::span<const Box> boxes, LocalSize* sizes);

}  // namespace deburr
