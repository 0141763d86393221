// Where a model keeps its edges: a radius of rounding that falls to nothing near edges of one kind, and in a region.
//
// The radius is r(x) = m + (R − m) Π S(uᵢ(x)), with S(u) = u²(3 − 2u) from u = 0 to 1, R the radius where nothing is
// kept and m one that no picture tells from 0. Of a region u is the distance from it, in widths of the border w. Of
// edges u = 1 − φ(x)/φ₀ where
//
//     φ(x) = ∫ (1 − |x − y|²/w²)² dy/w      over the edges' points y within w of x;   φ₀ = 8/15
//
// which does not depend on how an edge is divided; φ₀ is what a long straight edge has at its end, and half of what it
// has elsewhere, so that r is m in a tube around such edges. r has continuous first derivatives and bounded second
// ones.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "bounds/bounding_box.hpp"
#include "bounds/closed_mesh.hpp"
#include "bounds/range.hpp"

namespace deburr {

/// The edges and regions of a mesh that are not rounded.
struct KeptEdges {
    enum class Kind { none, convex, concave };
    Kind edges = Kind::none;   // those at which the faces turn by 30° or more
    std::vector<Box> regions;  // sides may be infinite
    double fade = 0;           // w > 0
};

class LocalRadius {
public:
    struct Segment {
        Vec3 from, to;
    };
    struct Value {
        double radius;
        Vec3 gradient;
    };
    /// Over a box: r, and at most |∇r| and the norm of its second derivative.
    struct Bounds {
        Range radius;
        double rate = 0, bend = 0;
    };

    /// `least`: m.
    LocalRadius(ClosedMeshPtr mesh, double radius, double least, KeptEdges kept);

    double full() const { return radius_; }
    double least() const { return least_; }
    double fade() const { return kept_.fade; }
    /// Appends the kept edges that may be within w of the box.
    void near(const Box& box, std::vector<Segment>& found) const;
    /// `edges`: all that are within w of x, or more.
    Value at(Vec3 x, std::span<const Segment> edges) const;
    /// `edges`: all that are within w of the finite box, or more.
    Bounds over(const Box& box, std::span<const Segment> edges) const;

private:
    ClosedMeshPtr mesh_;
    double radius_, least_;
    KeptEdges kept_;
    std::vector<unsigned char> is_kept_;  // of each triangle, a bit for each edge that it owns
};

}  // namespace deburr
