// Settings of implicit rendering: the acceleration structure, and the method of finding roots.
#pragma once

namespace deburr {

/// The acceleration structure that rays traverse; all find the same surfaces.
enum class Accel {
    bvh,    // Bvh8, over the content of the BSPs' cells
    embree  // Embree's BVH over the same boxes
};

inline const char* name(Accel accel) { return accel == Accel::embree ? "embree" : "bsp"; }

/// Which densities are intersected by the general root search, with its bounds M, L and G.
enum class RootMethod {
    where_needed,  // those that are neither products of half-spaces nor sums of few products
    always         // all of more than one half-space; for measuring the search itself
};

}  // namespace deburr
