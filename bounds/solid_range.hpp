// Primary CSG over a box: which subtrees are inside, outside or straddling there, and the little
// that matters [Lobb §3.5].
#pragma once
#include "bounds/box_range.hpp"
#include "bounds/solid_tree.hpp"

namespace deburr {

/// Where a region lies with respect to a op b, given where it lies with respect to a and b.
Side combine(SolidOp op, Side a, Side b);

/// The solid within the box: subtrees that the box lies inside or outside of are folded away, and
/// the densities of the others are local ones. The root is `nothing` or `everything` where that is
/// all there is.
SolidTree prune(const SolidTree& tree, const Box& box);

/// Where the box lies, and how many half-spaces, or their like in fields, `prune` would leave.
struct LocalSolidSize {
    Side side = Side::straddling;
    int leaves = 0, half_spaces = 0;
};
LocalSolidSize local_size(const SolidTree& tree, const Box& box);

/// The same in several boxes, which costs less than one after the other; `sizes` has room for one of each.
void local_sizes(const SolidTree& tree, std::span<const Box> boxes, LocalSolidSize* sizes);

}  // namespace deburr
