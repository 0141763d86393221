// Signed distance of a point from the surface of a solid, to first order, and the direction in which the surface faces.
//
// For a rounded density it is (ρ − ½)/|∇ρ|, for a field f/|∇f|, for a sharp density the planes' distances combined by
// min and max, and for the primary CSG tree again min and max. It is exact on the surface, correct to first order near
// it, and ±infinity where a density is saturated. Distances are in world space.
#pragma once
#include <memory>

#include "bounds/local_density.hpp"
#include "bounds/solid_tree.hpp"

namespace deburr {

/// The surface near a point.
struct SurfaceSample {
    double distance = 0;  // signed distance to first order; > 0 inside
    Vec3 normal{0.0};     // unit, outward; 0 where there is none
    int leaf = -1;        // leaf that the surface belongs to; −1: none
    int plane = -1;       // half-space of a sharp leaf that the surface belongs to; −1: none
};

/// A part of the surface that is smooth by itself: that of a rounded leaf, of a field, or of one half-space of a sharp
/// leaf.
struct SmoothPiece {
    int leaf = -1, plane = -1;
    double side = 1;  // −1: it is subtracted, so that its outside is the solid's inside
    bool operator==(const SmoothPiece&) const = default;
};

/// The signed distance of one solid, of which it keeps a copy. Not for several threads at once.
class SignedDistance {
public:
    explicit SignedDistance(const SolidTree& solid);

    /// The surface near x.
    SurfaceSample at(Vec3 x) const;
    /// Whether at(x).distance > 0, at less cost.
    bool inside(Vec3 x) const;
    /// All pieces of which the surface consists.
    std::vector<SmoothPiece> pieces() const;
    /// The surface of one piece near x, as if it were the solid's whole surface.
    SurfaceSample piece_at(const SmoothPiece& piece, Vec3 x) const;
    /// The distance from x to the surface along the normal at x, by root search up to `reach`; infinity if there is
    /// none.
    double distance_along_normal(Vec3 x, double reach) const;
    /// The signed distance of the solid pruned to the box; valid in the box.
    SignedDistance within(const Box& box) const;
    /// +infinity if the box is inside, −infinity if it is outside, 0 if that is not known.
    double constant_side(const Box& box) const;

    int material(int leaf) const { return solid_.leaves[leaf].material; }
    /// The line of the scene that wrote the leaf, or the leaf that it replaces; 0 unknown.
    int line(int leaf) const { return solid_.leaves[leaf].line; }
    /// Whether all half-spaces of the leaf are sharp.
    bool sharp(int leaf) const { return sharp_[leaf] && !solid_.leaves[leaf].field; }
    /// The number of half-spaces of all leaves, with Field::size() for fields.
    std::size_t half_spaces() const;

private:
    SurfaceSample leaf_at(std::size_t leaf, Vec3 x) const;
    double leaf_value(std::size_t leaf, Vec3 x) const;
    const LocalDensity& density(std::size_t leaf) const;

    SolidTree solid_;
    // Local densities of rounded leaves, made on demand because those of a whole solid may be huge.
    mutable std::vector<std::unique_ptr<LocalDensity>> densities_;
    std::vector<char> sharp_;
};

/// Signed distance at many points: a tree of boxes, split lazily, so that each point evaluates only the part of the
/// solid near it. Only one thread at a time may use it.
class DistanceField {
public:
    /// At a point of `box`, surfaces that are nearer than `margin` count, even beyond walls between boxes of the tree;
    /// farther ones may be missing. Where dozens of half-spaces vary within the margin, only much nearer ones are
    /// certain to count. A point outside of `box` gets the surfaces near the point of the box that is nearest to it.
    DistanceField(const SolidTree& solid, const Box& box, double margin = 0);

    SurfaceSample at(Vec3 x) const { return near(x).at(x); }
    bool inside(Vec3 x) const { return near(x).inside(x); }
    /// SignedDistance::distance_along_normal() of the part of the solid near x.
    double distance_along_normal(Vec3 x, double reach) const;
    /// The part of the solid that counts at x; it is valid for all points in the same box of the tree.
    const SignedDistance& near(Vec3 x) const;

private:
    struct Node {
        Node(const Box& around, std::shared_ptr<const SignedDistance> of_it, Node* within)
            : box(around),
              solid(std::move(of_it)),
              half_spaces(solid->half_spaces()),
              parent(within),
              depth(within ? within->depth + 1 : 0) {}
        Box box;
        std::shared_ptr<const SignedDistance> solid;  // pruned to this box or to one around it
        std::size_t half_spaces;
        Node* parent;  // null in the root
        int depth;
        std::unique_ptr<Node> children[2];
    };
    std::unique_ptr<Node> root_;
    mutable Node* last_ = nullptr;  // box of the last point: the next point is often in it
    double margin_;
};

}  // namespace deburr
