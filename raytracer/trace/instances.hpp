// Every bounded solid has a BSP of its own; equal solids share it, in a space of their own, so that a
// block that is placed 100,000 times costs one block and 100,000 maps.
//
// The first space is the world. What is placed in a space is found by the tree of boxes of the space's
// own surfaces; what occurs once and is not turned is such a surface itself. What is unbounded, or placed
// by a map that squeezes much, shares one BSP. A union is taken apart where its operands' boxes keep clear
// of each other, for there its surface is theirs.
#pragma once
#include <atomic>
#include <vector>

#include "raytracer/trace/surface_tracer.hpp"
#include "raytracer/util/large_pages.hpp"

namespace deburr {

struct alignas(64) Instance {  // two cache lines
    Affine into;               // from the space around to the placed one
    double stretch = 1;        // a distance there is at most this many times longer here
    int prototype = 0;         // that is placed
    int solid = 0;             // of the world; of no meaning in other spaces
    int material = -1;         // of what has none there; −1: that of the placement around, if any
    bool only_moved = false;   // neither turned nor scaled
};

static_assert(sizeof(Instance) == 128);
using Instances = std::vector<Instance, LargePages<Instance>>;

struct Prototype {
    SurfaceTracer bsp;  // its others are the placements
    Instances instances;
};

/// The world (the first) and all that is placed, in spaces of their own. Materials that are still to be named are
/// −1.
///
/// Of very many forms those that are quick to build are built by the first ray that enters their space, for most of
/// them are seldom seen. Whoever builds it, a space is the same: no result depends on the number of threads.
class Prototypes {
public:
    Prototypes(const std::vector<Solid>& solids, Criterion criterion, RootMethod root_method, Accel accel = Accel::bvh);
    ~Prototypes();
    Prototypes(const Prototypes&) = delete;
    Prototypes& operator=(const Prototypes&) = delete;

    std::size_t size() const { return prototypes_.size(); }
    const Prototype& operator[](std::size_t i) const {
        const Prototype* prototype = prototypes_[i].load(std::memory_order_acquire);
        return prototype ? *prototype : build(i);
    }
    /// Null if it has not been built yet.
    const Prototype* built(std::size_t i) const { return prototypes_[i].load(std::memory_order_acquire); }

private:
    const Prototype& build(std::size_t i) const;

    Criterion criterion_;
    RootMethod root_method_;
    Accel accel_;
    std::vector<Solid> later_;  // of the last spaces
    mutable std::vector<std::atomic<const Prototype*>> prototypes_;
};

}  // namespace deburr
