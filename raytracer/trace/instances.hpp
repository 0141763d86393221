// Instancing: equal bounded solids share one BSP, a prototype, in coordinates of its own, so that a block that is
// placed 100,000 times costs one block and 100,000 maps.
//
// The first prototype is the world. The instances in a prototype are found by the BVH over its own surfaces. A solid
// that occurs once and is not rotated is stored among these surfaces. Solids that are unbounded, or whose map is badly
// conditioned, share one BSP. A union is split into its operands where their boxes are disjoint, for there its surface
// is theirs.
#pragma once
#include <atomic>
#include <vector>

#include "raytracer/trace/bsp_store.hpp"
#include "raytracer/trace/surface_tracer.hpp"
#include "raytracer/util/large_pages.hpp"

namespace deburr {

/// A placement of one prototype in another.
struct alignas(64) Instance {  // two cache lines
    Affine into;               // from the coordinates of the prototype around to those of the placed one
    double stretch = 1;        // upper bound of how much longer a distance is around than in the placed prototype
    int prototype = 0;         // number of the placed prototype
    int solid = 0;             // in the world: its number in the scene; elsewhere unused
    int material = -1;         // of parts without one in the prototype; −1: that of the instance around, if any
    bool only_moved = false;   // the map is a translation
};

static_assert(sizeof(Instance) == 128);
using Instances = LargeVector<Instance>;

/// One prototype: the solids that are traced in it, and the instances placed in it.
struct Prototype {
    SurfaceTracer tracer;  // of its own surfaces, and the boxes of its instances
    Instances instances;
};

/// All prototypes of a scene, the world first. A material of −1 is to be taken from the instance around.
///
/// Where there are more than a thousand prototypes, the further ones that are quick to build are built when the first
/// ray enters one of their instances, since most are never seen. A prototype is the same whichever thread builds it, so
/// no result depends on the number of threads.
class Prototypes {
public:
    /// Builds the prototypes. `store`, if not null, provides the BSPs that an earlier scene had in common, and keeps
    /// these.
    Prototypes(const std::vector<Solid>& solids, Criterion criterion, RootMethod root_method, Accel accel = Accel::bvh,
               BspStore* store = nullptr);
    ~Prototypes();
    Prototypes(const Prototypes&) = delete;
    Prototypes& operator=(const Prototypes&) = delete;

    std::size_t size() const { return prototypes_.size(); }
    /// Prototype i, which is built now if it has not been yet. Thread-safe.
    const Prototype& operator[](std::size_t i) const {
        const Prototype* prototype = prototypes_[i].load(std::memory_order_acquire);
        return prototype ? *prototype : build(i);
    }
    /// Prototype i; null if it has not been built yet.
    const Prototype* built(std::size_t i) const { return prototypes_[i].load(std::memory_order_acquire); }

private:
    const Prototype& build(std::size_t i) const;

    Criterion criterion_;
    RootMethod root_method_;
    Accel accel_;
    std::vector<Solid> later_;  // of the last prototypes, which are built on demand
    mutable std::vector<std::atomic<const Prototype*>> prototypes_;
};

}  // namespace deburr
