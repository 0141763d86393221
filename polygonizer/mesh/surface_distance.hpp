// How far a point is from the surface of a solid, to first order, and which way the surface faces.
//
// For a rounded density that is (ρ − ½)/|∇ρ|; for a field f/|∇f|; for a sharp density the planes' distances under min
// and max; for the primary CSG tree min and max again. Exact on the surface, right to first order near it; ±infinity
// where a density is saturated.
#pragma once
#include <memory>

#include "bounds/local_density.hpp"
#include "bounds/solid_tree.hpp"

namespace deburr {

struct SurfaceSample {
    double distance = 0;  // > 0 inside
    Vec3 normal{0.0};     // unit, outward; 0 where there is none
    int leaf = -1;        // that the surface nearby belongs to
    int plane = -1;       // of a sharp leaf: which half-space's
};

/// A part of the surface that is smooth by itself: a rounded leaf, a field, or one half-space of a sharp leaf.
struct SmoothPiece {
    int leaf = -1, plane = -1;
    double side = 1;  // −1: subtracted, so that the piece's outside is the solid's inside
    bool operator==(const SmoothPiece&) const = default;
};

/// Not for several threads at once.
class SignedDistance {
public:
    explicit SignedDistance(const SolidTree& solid);

    SurfaceSample at(Vec3 x) const;
    /// Whether at(x).distance > 0, at less cost.
    bool inside(Vec3 x) const;
    /// All pieces that the surface is made of.
    std::vector<SmoothPiece> pieces() const;
    /// Signed distance and normal of one piece alone, as if it were the solid's whole surface.
    SurfaceSample piece_at(const SmoothPiece& piece, Vec3 x) const;
    /// Distance from x to the surface along the normal there, by root search no farther than
    /// `reach`; infinity if there is none.
    double distance_along_normal(Vec3 x, double reach) const;
    /// Only what matters in the box.
    SignedDistance within(const Box& box) const;
    /// If the box lies on one side: ±infinity; else 0.
    double constant_side(const Box& box) const;

    int material(int leaf) const { return solid_.leaves[leaf].material; }
    /// The line of the scene that wrote the leaf, or what was put in its place.
    int line(int leaf) const { return solid_.leaves[leaf].line; }
    bool sharp(int leaf) const { return sharp_[leaf] && !solid_.leaves[leaf].field; }
    std::size_t half_spaces() const;

private:
    SurfaceSample leaf_at(std::size_t leaf, Vec3 x) const;
    double leaf_value(std::size_t leaf, Vec3 x) const;
    const LocalDensity& density(std::size_t leaf) const;

    SolidTree solid_;
    // Of rounded leaves, made when first asked: of a whole solid they may be huge.
    mutable std::vector<std::unique_ptr<LocalDensity>> densities_;
    std::vector<char> sharp_;
};

/// SignedDistance for many points: a tree of boxes, split lazily, so that each point evaluates only
/// the part of the solid near it. One thread at a time may use it.
class DistanceField {
public:
    /// Surfaces that are nearer to a point than `margin` matter there, whether or not it is beyond them: farther ones
    /// may be missing. Where dozens of half-spaces vary within it, only those that are much nearer matter. A point
    /// beyond the box is told of the surfaces near that part of the box which is nearest to it.
    DistanceField(const SolidTree& solid, const Box& box, double margin = 0);

    SurfaceSample at(Vec3 x) const { return near(x).at(x); }
    bool inside(Vec3 x) const { return near(x).inside(x); }
    /// SignedDistance::distance_along_normal of the part of the solid near x.
    double distance_along_normal(Vec3 x, double reach) const;
    /// The part of the solid that matters at x; it serves for all points in the same box of the tree.
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
        std::shared_ptr<const SignedDistance> solid;  // of this box, or of one around it
        std::size_t half_spaces;
        Node* parent;  // null: the root
        int depth;
        std::unique_ptr<Node> children[2];
    };
    std::unique_ptr<Node> root_;
    mutable Node* last_ = nullptr;  // that a point asked for: the next is often in its box as well
    double margin_;
};

}  // namespace deburr
