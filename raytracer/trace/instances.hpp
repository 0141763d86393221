// Every bounded solid has a BSP of its own; equal solids share it, in a space of their own, so that a
// block that is placed 100,000 times costs one block and 100,000 maps.
//
// The first space is the world. What is placed in a space is found by the tree of boxes of the space's
// own surfaces; what occurs once and is not turned is such a surface itself. What is unbounded, or placed
// by a map that squeezes much, shares one BSP. A union is taken apart where its operands' boxes keep clear
// of each other, for there its surface is theirs.
#pragma once
#include <vector>

#include "raytracer/trace/surface_tracer.hpp"
#include "raytracer/util/large_pages.hpp"

namespace deburr {

struct alignas(64) Placement {  // two cache lines
    Affine into;                // from the space around to the placed one
    double stretch = 1;         // a distance there is at most this many times longer here
    int space = 0;              // that is placed
    int solid = 0;              // of the world; of no meaning in other spaces
    int material = -1;          // of what has none there; −1: that of the placement around, if any
    bool only_moved = false;    // neither turned nor scaled
};

static_assert(sizeof(Placement) == 128);
using Placements = std::vector<Placement, LargePages<Placement>>;

struct Space {
    BspTracer bsp;  // its others are the placements
    Placements placements;
};

/// Materials that are still to be named are −1. The result does not depend on the number of threads.
std::vector<Space> build_spaces(const std::vector<Solid>& solids, Criterion criterion, Search search,
                                Accel accel = Accel::bsp);

}  // namespace deburr
