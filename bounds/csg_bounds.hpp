// Inner and outer bound CSG of a density at a threshold [Lobb §3.3, figure 8, appendix], and the
// stretches of a ray where the isosurface can be.
//
//   outer bound O(ρ, t):  x ∉ O ⇒ ρ(x) ≤ t        [Lobb eq. 3]
//   inner bound I(ρ, t):  x ∈ I ⇒ ρ(x) ≥ t        [Lobb eq. 4]
//
// Printed differently: theorems 4–6 are headed "outer bound"; what they state and prove is inner.
// Conjunctions, disjunctions and complements follow the Fréchet inequalities instead, which hold
// whatever the operands share, and so for true convolution as well.
//
// Both hold in floating point for points no farther from the origin than the planes are.
#pragma once
#include <vector>

#include "bounds/density_tree.hpp"

namespace deburr {

struct BoundPlane {
    Vec3 normal;
    double offset;
};

/// A plain CSG object over half-spaces.
struct BoundCsg {
    enum class Kind : unsigned char { nothing, everything, plane, intersect, unite, complement };
    struct Node {
        Kind kind = Kind::nothing;
        int a = -1, b = -1;  // children; plane: a is its index
    };
    std::vector<BoundPlane> planes;
    std::vector<Node> nodes;  // children before parents, the root last
    bool convex = false;      // an intersection of planes and nothing else

    bool contains(Vec3 x) const;
};

/// The theorems ask for operands in [0, 1] (box_range.hpp: bounds_hold). Every plane keeps clear by the distance
/// `clearance` besides, outward of an outer bound, inward of an inner one.
BoundCsg outer_bound(const DensityTree& tree, double t, double clearance = 0);
BoundCsg inner_bound(const DensityTree& tree, double t, double clearance = 0);

struct Span {
    double lo, hi;
};

/// The stretches of a ray in which a density can cross ½: in the outer bound, not in the inner one.
/// Cheap to use again and again: keeps its memory.
class SearchSpans {
public:
    /// Stretches within [t0, t1], in order. Valid until the next call.
    const std::vector<Span>& between(const BoundCsg& outer, const BoundCsg& inner, Vec3 origin, Vec3 direction,
                                     double t0, double t1);

private:
    struct Part {
        std::size_t first = 0, count = 0;
    };
    void general(const BoundCsg& csg, Vec3 origin, Vec3 direction);
    std::vector<Span> pool_, inside_, result_;
    std::vector<Part> parts_;
};

}  // namespace deburr
