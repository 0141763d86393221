// Primary CSG over a box: which subtrees the box is inside of, outside of or straddles, and the local CSG that is left
// [Lobb §3.5].
#pragma once
#include "bounds/box_range.hpp"
#include "bounds/solid_tree.hpp"

namespace deburr {

/// The side of a region with respect to `a op b`, from its sides with respect to a and b. `op` is unite, intersect or
/// subtract.
Side combine(SolidOp op, Side a, Side b);

/// The solid within the box: subtrees that the box lies inside or outside of are folded away, and leaves are pruned to
/// their local densities and fields. The root is a single `nothing` or `everything` where the box does not straddle the
/// solid.
SolidTree prune(const SolidTree& tree, const Box& box);

/// The box's side with respect to the solid, and how many leaves and half-spaces (of fields Field::size() counts)
/// prune() would leave.
struct LocalSolidSize {
    Side side = Side::straddling;
    int leaves = 0, half_spaces = 0;
};
/// The size of the local CSG, at less cost than prune().
LocalSolidSize local_size(const SolidTree& tree, const Box& box);

/// local_size() in several boxes, at less cost than one after the other; sizes[k] is set for boxes[k], so `sizes` has
/// room for as many.
void local_sizes(const SolidTree& tree, std::span<const Box> boxes, LocalSolidSize* sizes);

}  // namespace deburr
