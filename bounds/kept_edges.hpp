// Selective rounding: a rounding radius that falls to almost nothing near edges of one kind and in regions of space.
//
// The radius is r(x) = m + (R − m) Π S(uᵢ(x)), with the smooth step S(u) = u²(3 − 2u) from u = 0 to 1, the radius R
// where nothing is kept sharp, and a radius m that no picture distinguishes from 0. For a region u is the distance from
// it in widths w of its border. For edges u = 1 − φ(x)/φ₀ with
//
//     φ(x) = ∫ (1 − |x − y|²/w²)² dy/w      over the edges' points y within w of x;   φ₀ = 8/15
//
// which does not depend on how an edge is divided. φ₀ is φ at the end of a long straight edge, half of φ elsewhere on
// it, so that r is m in a tube around such edges. r has continuous first and bounded second derivatives.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "bounds/bounding_box.hpp"
#include "bounds/closed_mesh.hpp"
#include "bounds/range.hpp"

namespace deburr {

/// Which edges and regions of a mesh stay sharp. Distances are in the mesh's space.
struct KeptEdges {
    enum class Kind { none, convex, concave };
    Kind edges = Kind::none;   // which of the edges at which faces turn by 30° or more stay sharp
    std::vector<Box> regions;  // boxes within which all stays sharp; sides may be infinite
    double fade = 0;           // w > 0: distance over which the radius fades
};

/// The radius r(x). Immutable, and safe to use from several threads.
class LocalRadius {
public:
    /// A kept edge.
    struct Segment {
        Vec3 from, to;
    };
    struct Value {
        double radius;
        Vec3 gradient;
    };
    /// Over a box: the range of r, and upper bounds of |∇r| and of the norm of r's second derivative.
    struct Bounds {
        Range radius;
        double rate = 0, bend = 0;
    };

    /// `radius` is R and `least` is m, 0 < m ≤ R.
    LocalRadius(ClosedMeshPtr mesh, double radius, double least, KeptEdges kept);

    /// R, m and w.
    double full() const { return radius_; }
    double least() const { return least_; }
    double fade() const { return kept_.fade; }
    /// Appends the kept edges that may be within w of the box.
    void near(const Box& box, std::vector<Segment>& found) const;
    /// r and ∇r at x. `edges` holds at least all kept edges within w of x.
    Value at(Vec3 x, std::span<const Segment> edges) const;
    /// Bounds of r over the finite box. `edges` holds at least all kept edges within w of it.
    Bounds over(const Box& box, std::span<const Segment> edges) const;

private:
    ClosedMeshPtr mesh_;
    double radius_, least_;
    KeptEdges kept_;
    std::vector<unsigned char> is_kept_;  // for each triangle, bit k if it owns edge k and that is kept
};

}  // namespace deburr
