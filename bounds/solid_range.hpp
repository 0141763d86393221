// Primary CSG over a box: which subtrees are inside, outside or straddling there, and the little
// that matters [Lobb §3.5].
#pragma once
#include "bounds/box_range.hpp"
#include "bounds/solid_tree.hpp"

namespace deburr {

/// The side on which a region lies of a op b, from the sides on which it lies of a and of b.
Side combine(SolidOp op, Side a, Side b);

/// The solid within the box: subtrees that the box lies inside or outside of are folded away, and
/// the densities of the others are local ones. The root is `nothing` or `everything` where that is
/// all there is.
SolidTree prune(const SolidTree& tree, const Box& box);

/// The box's side of the solid, and how many leaves and half-spaces (of fields: Field::size) `prune` would leave.
struct LocalSolidSize {
    Side side = Side::straddling;
    int leaves = 0, half_spaces = 0;
};
LocalSolidSize local_size(const SolidTree& tree, const Box& box);

/// local_size in several boxes at less cost than one after the other; sizes[k] is that of boxes[k].
void local_sizes(const SolidTree& tree, std::span<const Box> boxes, LocalSolidSize* sizes);

}  // namespace deburr
