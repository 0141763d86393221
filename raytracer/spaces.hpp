// Every bounded solid has a space of its own, with its BSP; equal ones share it, so that a block that
// is placed 100,000 times costs one block and 100,000 maps.
//
// The first space is the world. What is placed in a space is found by a hierarchy over the placements'
// boxes; what is unbounded, or placed by a map that squeezes much, is in the space's own BSP. A union
// is taken apart where its operands' boxes keep clear of each other, for there its surface is theirs.
#pragma once
#include <vector>

#include "raytracer/box_hierarchy.hpp"
#include "raytracer/bsp_trace.hpp"

namespace deburr {

struct Placement {
    Affine into;         // from the space around to the placed one
    double stretch = 1;  // a distance there is at most this many times longer here
    int space = 0;       // that is placed
    int solid = 0;       // of the world; of no meaning in other spaces
    int material = -1;   // of what has none there; −1: that of the placement around, if any
    bool only_moved = false;  // neither turned nor scaled
};

struct Space {
    BspTracer bsp;
    std::vector<int> solids;  // in the world's numbers, by the BSP's
    std::vector<Placement> placements;
    BoxHierarchy hierarchy;  // over the placements
    Box box;                 // of what is in it, where it is placed
};

/// Materials that are still to be named are −1. The result does not depend on the number of threads.
std::vector<Space> build_spaces(const std::vector<Solid>& solids, Criterion criterion, Search search);

}  // namespace deburr
