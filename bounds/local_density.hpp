// A density prepared for fast evaluation: the papers' arithmetic as it is written, Boolean parts as decision diagrams,
// a true convolution in closed form (ball_convolution.hpp). It is meant for the little that is left of a tree in a cell
// (box_range.hpp), and right for any tree.
//
// Along a ray every plane's α is linear in t, so a ray is a small table of coefficients: RayDensity.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "bounds/ball_convolution.hpp"
#include "bounds/box_range.hpp"
#include "bounds/density_tree.hpp"
#include "bounds/field.hpp"
#include "bounds/ray_bounds.hpp"

namespace deburr {

/// A prepared density, or a rounded mesh. Immutable after construction; it shares what it needs of the tree.
class LocalDensity {
public:
    /// Throws TooEntangled where a Boolean part's diagram would be too large.
    explicit LocalDensity(const DensityTree& tree);
    /// A rounded mesh: ρ = f + ½ for a field f that is_density(). half_spaces() are Field::planes(), planes that the
    /// mesh is worth cutting by; they do not make up the density. Valid are field(), at(), gradient_at() and
    /// range(box); ranges over other regions are [0, 1], rates (−∞, ∞), and as_product() and as_sum() give nothing. No
    /// RayDensity can be set to it.
    explicit LocalDensity(FieldPtr field);
    /// The field of a rounded mesh; null for a density of half-spaces.
    const Field* field() const { return field_.get(); }

    /// The half-spaces that the expression still depends on. Those of a Boolean part are its families' planes: their
    /// normals may be opposite to those in the scene.
    const std::vector<HalfSpace>& half_spaces() const { return half_spaces_; }
    /// Whether some half-space has a filter radius of 0.
    bool has_sharp() const { return has_sharp_; }
    /// Whether some half-space is a round part.
    bool has_round() const { return rounds_ != nullptr; }
    /// Owns the coordinates that the round parts of half_spaces() point to; null if there are none.
    const std::shared_ptr<const std::deque<RoundCoordinate>>& rounds() const { return rounds_; }

    /// F, the density of half_spaces()[half_space], or 1 − F.
    struct Factor {
        int half_space;
        bool flipped;  // 1 − F instead of F
    };
    /// The product of the factors, or one minus it.
    struct Product {
        std::vector<Factor> factors;
        bool complement = false;  // 1 − the product
    };
    /// The density as a product of half-spaces if the expression shows that it is one; else none.
    std::optional<Product> as_product() const;
    /// constant + Σ weight · (product of the term's factors).
    struct Sum {
        struct Term {
            double weight;
            std::vector<Factor> factors;
        };
        double constant = 0;
        std::vector<Term> terms;
    };
    /// The density multiplied out into a constant and at most `max_terms` weighted products of half-spaces. None if
    /// there would be more terms, if there are more than 64 half-spaces, or for a convolution.
    std::optional<Sum> as_sum(std::size_t max_terms) const;
    /// True if ρ is a polynomial of degree at most 1 in each variable, where half-space i's density is a linear
    /// function of variable number variable_of[i] alone; false says nothing.
    bool is_affine_in_each(const std::vector<int>& variable_of) const;

    /// ρ at x.
    double at(Vec3 x) const;
    /// ρ and ∇ρ at x; sharp half-spaces contribute no slope.
    ValueGradient gradient_at(Vec3 x) const;
    /// Range of ρ over a box; tighter than density_range() of the tree, because a diagram sees what operands share.
    Range range(const Box& box) const;
    /// Range of ρ over any region, given the range of the density of each of half_spaces() over it.
    Range range(std::span<const Range> half_spaces) const;
    /// Range of the rate at which ρ changes in some direction over a region, given for each of half_spaces() the range
    /// of its density there and of the rate at which that changes in the direction. It is sound. Where enlarging a
    /// half-space can only enlarge the Boolean function's set, or only shrink it, the sign of its contribution is kept.
    /// For a true convolution only signs are known: each end of the range is then 0 or infinite.
    Range rate_range(std::span<const Range> half_spaces, std::span<const Range> rates) const;

private:
    friend class RayDensity;

    enum class Step : unsigned char { constant, half_space, sum, product, difference, complement, decision };
    struct Node {
        Step step = Step::constant;
        int a = -1, b = -1;  // operands; half_space: a is its index in half_spaces_; decision: children_[a …] holds b
                             // thresholds (indices of half-spaces), then b + 1 children
        double value = 0;    // constant; difference, complement: 1 if no operand is ever negative
    };

    template <class OfHalfSpace>
    Range range_from(OfHalfSpace of_half_space) const;
    int add(Node node);
    int add_boolean(const DensityTree& tree, int root);
    void find_polarities(const DensityTree& tree, int root, std::size_t first);

    FieldPtr field_;
    std::shared_ptr<const std::deque<RoundCoordinate>> rounds_;  // owns what half_spaces_ point to
    std::shared_ptr<const BallConvolution> convolution_;  // null unless it is a true convolution, which has no nodes
    std::vector<HalfSpace> half_spaces_;
    std::vector<Node> nodes_;  // operands first, the root last
    /// Thresholds and children of the decision nodes.
    std::vector<int> children_;
    // The effect of enlarging half-space i on the set of its Boolean part: 1, it can only grow; −1, it can only shrink;
    // 0, either.
    std::vector<signed char> polarity_;
    bool has_sharp_ = false;
};

/// M, L and G of the density of a round part on [t0, t1]. G is valid for the sum over all parts in a density, not for
/// each part alone: where the ray comes near the axis and the filter is wider than the part, a part alone has a kink
/// there, and only the two parts of one coordinate together are smooth.
RayBounds round_part_bounds(const HalfSpace& part, const RoundOnRay& on_ray, double t0, double t1);

/// A local density along the ray o + t·d. It keeps its memory from one ray to the next, so it is cheap to set again.
class RayDensity {
public:
    static constexpr double level = 0.5;  // ρ on the surface

    /// Sets the ray. Keeps a reference to `density`, which is not a rounded mesh. t is a world
    /// distance where `direction` is a unit vector.
    void set(const LocalDensity& density, Vec3 origin, Vec3 direction);

    /// ρ and dρ/dt.
    ValueSlope at(double t) const;
    /// M, L and G of ρ over [t0, t1].
    RayBounds bounds(double t0, double t1) const;
    /// ∇ρ at o + t·d.
    Vec3 gradient(double t) const;

    /// Fixes each sharp half-space to the side on which it is at t: it counts as constant 0 or 1 until the next call.
    void fix_sharp(double t);

    /// Number of half-spaces. Below, i is the index of one that is not a round part.
    std::size_t size() const { return lines_.size(); }
    /// α of half-space i at t; ±2 if it is sharp, by the side on which it is fixed.
    double alpha(std::size_t i, double t) const { return lines_[i].a + lines_[i].b * t; }
    const LocalDensity& density() const { return *density_; }
    /// Signed distance of the origin from half-space i's plane, and its derivative by t.
    double distance0(std::size_t i) const { return lines_[i].distance; }
    double distance_rate(std::size_t i) const { return lines_[i].rate; }
    /// The t at which the ray meets half-space i's plane; not finite where the ray is parallel to it.
    double plane_crossing(std::size_t i) const { return -lines_[i].distance / lines_[i].rate; }

private:
    struct Line {
        double distance, rate;  // distance from the plane at t = 0, and its derivative
        double a, b;            // α = a + b·t; sharp: a = ±2 by the side, b = 0
    };
    const LocalDensity* density_ = nullptr;
    std::vector<Line> lines_;
    mutable std::vector<ValueSlope> leaf_;
    mutable std::vector<RayBounds> leaf_bounds_, bounds_;

    // The round parts, which have no line.
    struct Round {
        std::size_t half_space;
        RoundOnRay on_ray;
    };
    void evaluate_rounds(double t) const;
    Vec3 origin_{0.0}, direction_{0.0};
    std::vector<Round> rounds_;

    // Of a true convolution: all α at t, and their rates; slopes_ holds the derivative of ρ by each α.
    void alphas(double t, std::vector<double>& all) const;
    double speed_ = 0;  // |d| in radii of the ball
    std::vector<double> rates_;
    mutable std::vector<double> alphas_, alphas_at_end_, slopes_;
};

}  // namespace deburr
