// How the implicit road finds what a ray may cross, and roots.
#pragma once

namespace deburr {

/// Acceleration structure in which rays are traced; the surfaces that they find are the same.
enum class Accel {
    bvh,    // a tree of boxes around what is in the cells of BSPs
    embree  // the same boxes under a BVH of Embree's
};

inline const char* name(Accel accel) { return accel == Accel::embree ? "embree" : "bsp"; }

/// Which densities' roots are searched for by the bounds M, L and G.
enum class RootMethod {
    where_needed,  // those that are neither products of half-spaces nor sums of few
    always         // of more than one half-space; for measuring the search itself
};

}  // namespace deburr
