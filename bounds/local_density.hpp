// A density made ready for fast evaluation: the papers' arithmetic as it stands, Boolean parts as
// decision diagrams, a true convolution as the share of a ball. Meant for the little that is left of a
// tree in a cell (box_range.hpp), right for any.
//
// Along a ray every α is linear in t, so a ray is a small table of them: RayDensity.
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

class LocalDensity {
public:
    explicit LocalDensity(const DensityTree& tree);
    /// A rounded mesh: ρ = f + ½. Its half-spaces are the field's planes, of which only at(), gradient_at() and the
    /// ranges over boxes make something else than a guess.
    explicit LocalDensity(FieldPtr field);
    /// Null for a density of half-spaces.
    const Field* field() const { return field_.get(); }

    /// The half-spaces that matter, each with its normal as the expression needs it.
    const std::vector<HalfSpace>& half_spaces() const { return half_spaces_; }
    bool has_sharp() const { return has_sharp_; }
    /// Whether some of them are round parts.
    bool has_round() const { return rounds_ != nullptr; }
    /// The coordinates that half_spaces() point to; null where none is round.
    const std::shared_ptr<const std::deque<RoundCoordinate>>& rounds() const { return rounds_; }

    struct Factor {
        int half_space;
        bool flipped;  // 1 − F
    };
    struct Product {
        std::vector<Factor> factors;
        bool complement = false;  // one minus the product
    };
    /// The density written as a product of half-spaces, if it can be read off the expression.
    std::optional<Product> as_product() const;
    struct Sum {
        struct Term {
            double weight;
            std::vector<Factor> factors;
        };
        double constant = 0;
        std::vector<Term> terms;
    };
    /// The density multiplied out: a constant and weighted products of half-spaces, if the products are no
    /// more than `max_terms`; of few half-spaces only.
    std::optional<Sum> as_sum(std::size_t max_terms) const;
    /// Whether ρ is a polynomial of degree 1 in each of several variables, of which variable_of[i] is
    /// the one that half-space i is a linear function of.
    bool is_affine_in_each(const std::vector<int>& variable_of) const;

    double at(Vec3 x) const;
    ValueGradient gradient_at(Vec3 x) const;
    /// ρ over a box; tighter than the tree's, as it sees what operands share.
    Range range(const Box& box) const;
    /// ρ over any region, given the range of the density of each of half_spaces() over it.
    Range range(std::span<const Range> half_spaces) const;
    /// The rate at which ρ changes in some direction, over any region, given for every half-space its ρ over the
    /// region and the rate at which that changes in the direction. Sound; where a half-space's side of a Boolean
    /// function is known (it can only enlarge the solid, or only shrink it) the sign is kept. Of a true
    /// convolution only the sign is known: the range is then half a line, or a line.
    Range rate_range(std::span<const Range> half_spaces, std::span<const Range> rates) const;

private:
    friend class RayDensity;

    enum class Step : unsigned char { constant, half_space, sum, product, difference, complement, decision };
    struct Node {
        Step step = Step::constant;
        int a = -1, b = -1;  // operands; half_space: a is its index;
                             // decision: children_[a …] are b thresholds (half-spaces), then b + 1 children
        double value = 0;    // constant; difference, complement: 1 if no operand is ever negative
    };

    template <class OfHalfSpace>
    Range range_from(OfHalfSpace of_half_space) const;
    int add(Node node);
    int add_boolean(const DensityTree& tree, int root);
    void find_polarities(const DensityTree& tree, int root, std::size_t first);

    FieldPtr field_;
    std::shared_ptr<const std::deque<RoundCoordinate>> rounds_;  // what half_spaces_ point to
    std::shared_ptr<const BallConvolution> convolution_;         // of a true convolution, which needs no nodes
    std::vector<HalfSpace> half_spaces_;
    std::vector<Node> nodes_;  // operands first, the root last
    std::vector<int> children_;
    // What more of a half-space does to the Boolean function that it is part of: 1, it is true in more places; −1, in
    // fewer; 0, either.
    std::vector<signed char> polarity_;
    bool has_sharp_ = false;
};

/// M, L and G of a round part on [t0, t1], which bound the sum of all in a density: where the ray comes near to the
/// axis of a filter that is wider, a part alone has a kink there, and what has none is its pair on either side.
RayBounds round_part_bounds(const HalfSpace& part, const RoundOnRay& on_ray, double t0, double t1);

/// A local density along the ray o + t·d. Cheap to set up again and again: keeps its memory.
class RayDensity {
public:
    static constexpr double level = 0.5;  // of ρ on the surface

    /// Keeps a reference to `density`.
    void set(const LocalDensity& density, Vec3 origin, Vec3 direction);

    /// ρ and dρ/dt.
    ValueSlope at(double t) const;
    /// M, L and G of ρ over [t0, t1].
    RayBounds bounds(double t0, double t1) const;
    Vec3 gradient(double t) const;

    /// Puts every sharp half-space on the side where it is at t; it stays there until the next call.
    void fix_sharp(double t);

    std::size_t size() const { return lines_.size(); }
    double alpha(std::size_t i, double t) const { return lines_[i].a + lines_[i].b * t; }
    const LocalDensity& density() const { return *density_; }
    /// Distance of the origin from half-space i's plane, and its change with t.
    double distance0(std::size_t i) const { return lines_[i].distance; }
    double distance_rate(std::size_t i) const { return lines_[i].rate; }
    /// The t at which the ray meets half-space i's plane; not finite where they are parallel.
    double plane_crossing(std::size_t i) const { return -lines_[i].distance / lines_[i].rate; }

private:
    struct Line {
        double distance, rate;  // from the plane
        double a, b;            // α = a + b·t; sharp: a = ±2, b = 0, by the side
    };
    const LocalDensity* density_ = nullptr;
    std::vector<Line> lines_;
    mutable std::vector<ValueSlope> leaf_;
    mutable std::vector<RayBounds> leaf_bounds_, bounds_;

    // Of round parts; they have no line.
    struct Round {
        std::size_t half_space;
        RoundOnRay on_ray;
    };
    void evaluate_rounds(double t) const;
    Vec3 origin_{0.0}, direction_{0.0};
    std::vector<Round> rounds_;

    // Of a true convolution: every α, its rate, and the share's slope by it.
    void alphas(double t, std::vector<double>& all) const;
    double speed_ = 0;  // in radii of the ball
    std::vector<double> rates_;
    mutable std::vector<double> alphas_, alphas_at_end_, slopes_;
};

}  // namespace deburr
