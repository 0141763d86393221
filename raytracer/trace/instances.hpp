// Instancing. Each bounded solid gets a BSP; equal solids share one, a prototype, in coordinates of its own,
// so that a block that is placed 100,000 times costs one block and 100,000 maps.
//
// The first prototype is the world. The instances in a prototype are found by the BVH of its own surfaces;
// a solid that occurs once and is not turned is among these surfaces. Solids that are unbounded, or placed
// by a map that squeezes much, share one BSP. A union is split into its operands where their boxes are
// disjoint, for there its surface is theirs.
#pragma once
#include <atomic>
#include <vector>

#include "raytracer/trace/bsp_store.hpp"
#include "raytracer/trace/surface_tracer.hpp"
#include "raytracer/util/large_pages.hpp"

namespace deburr {

struct alignas(64) Instance {  // two cache lines
    Affine into;               // from the coordinates around to the prototype's
    double stretch = 1;        // a distance in the prototype is at most this many times longer around
    int prototype = 0;         // number of the prototype that is placed
    int solid = 0;             // the scene's number of it, in the world; of no meaning in other prototypes
    int material = -1;         // of parts that have none in the prototype; −1: that of the instance around, if any
    bool only_moved = false;   // neither turned nor scaled
};

static_assert(sizeof(Instance) == 128);
using Instances = LargeVector<Instance>;

struct Prototype {
    SurfaceTracer bsp;  // its own surfaces, and the boxes of its instances
    Instances instances;
};

/// The world (the first) and the prototypes of all instances. A material that the instance around has to name is
/// −1.
///
/// Of very many prototypes those that are quick to build are built by the first ray that enters one of their instances,
/// for most are seldom seen. Whoever builds it, a prototype is the same: no result depends on the number of threads.
class Prototypes {
public:
    /// Of an earlier scene, `store` has its BSPs, and gets this one's; null: there is none.
    Prototypes(const std::vector<Solid>& solids, Criterion criterion, RootMethod root_method, Accel accel = Accel::bvh,
               BspStore* store = nullptr);
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
    std::vector<Solid> later_;  // of the last prototypes, which are built when a ray comes
    mutable std::vector<std::atomic<const Prototype*>> prototypes_;
};

}  // namespace deburr
