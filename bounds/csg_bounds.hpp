// Inner and outer bound CSG of a density at a threshold [Lobb §3.3, figure 8, appendix], and the spans of a ray in
// which the isosurface can be.
//
//   outer bound O(ρ, t):  x ∉ O ⇒ ρ(x) ≤ t        [Lobb eq. 3]
//   inner bound I(ρ, t):  x ∈ I ⇒ ρ(x) ≥ t        [Lobb eq. 4]
//
// Printed differently: theorems 4–6 are headed "outer bound"; what they state and prove is inner.
// Conjunctions, disjunctions and complements follow the Fréchet inequalities instead, which hold
// whatever the operands share, and so for true convolution as well.
//
// Both hold in floating point for points that are no farther from the origin than the planes.
#pragma once
#include <vector>

#include "bounds/density_tree.hpp"

namespace deburr {

/// The half-space n·x ≤ offset, with a unit normal.
struct BoundPlane {
    Vec3 normal;
    double offset;
};

/// A CSG object whose primitives are sharp half-spaces.
struct BoundCsg {
    enum class Kind : unsigned char { nothing, everything, plane, intersect, unite, complement };
    struct Node {
        Kind kind = Kind::nothing;
        int a = -1, b = -1;  // children; plane: a is its index in planes
    };
    std::vector<BoundPlane> planes;
    std::vector<Node> nodes;  // children before parents, the root last
    bool convex = false;      // an intersection of planes and nothing else

    bool contains(Vec3 x) const;
};

/// Bounds of the density at threshold t. The theorems require that operands are in [0, 1] (bounds_hold() in
/// box_range.hpp). Every plane is displaced by the world distance `clearance` besides: outward in an outer bound,
/// inward in an inner one.
BoundCsg outer_bound(const DensityTree& tree, double t, double clearance = 0);
BoundCsg inner_bound(const DensityTree& tree, double t, double clearance = 0);

/// A closed interval of ray parameters.
struct Span {
    double lo, hi;
};

/// Spans of a ray in which a density can cross ½: those inside the outer bound and outside of the inner one. The object
/// keeps its memory, so it is cheap to use again and again.
class SearchSpans {
public:
    /// The spans within [t0, t1], in order. The list is valid until the next call.
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
