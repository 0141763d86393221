// A rounded density in POV-Ray's language: a formula of x, y and z, and a proven bound of its slope.
//
// The papers' arithmetic is written as it stands. A Boolean part is its decision diagram expanded to Σ pⱼ cⱼ, decision
// by decision (bounds/decision_diagram.hpp). As POV-Ray's functions have no variables, a shared node of a diagram is
// written once per use; formulas that grow too long are not supported.
#pragma once
#include <string>
#include <vector>

#include "bounds/box_range.hpp"

namespace deburr {

/// The declaration of the profile ρ(α) under the name Rho: by cases, or clamped by min and max.
std::string pov_profile(bool by_cases);

/// The formula of one density.
class PovField {
public:
    /// Precondition: no half-space of `tree` is sharp. Throws TooEntangled with the line of the scene if a diagram is
    /// too large.
    explicit PovField(const DensityTree& tree, int line = 0);

    /// The formula of ρ. Throws UnsupportedError if it has more than `max_terms` half-spaces, counted once per use.
    std::string formula() const;
    static constexpr double max_terms = 20'000;

    /// An upper bound of |∇ρ| in the finite box. The box is halved where the bound is largest, until it is within 1 %
    /// of a slope that occurs or the work is spent.
    double greatest_slope(const Box& box) const;

private:
    // A node of the formula.
    enum class Step : unsigned char { constant, half_space, sum, product, difference, decision };
    struct Node {
        Step step = Step::constant;
        double value = 0;                   // of a constant
        int a = -1, b = -1;                 // operands; half_space: a is its index
        std::vector<int> planes, children;  // of a decision: as in Decision, planes by index
    };
    struct Slopes;

    int add_boolean(const DensityTree& tree, int root);
    int add(Node node);
    std::string decision(const Node& node, const std::vector<std::string>& done) const;
    Slopes slopes(const Box& box) const;

    int line_;
    std::vector<HalfSpace> half_spaces_;
    std::shared_ptr<const std::deque<RoundCoordinate>> rounds_;  // owns the coordinates of half_spaces_
    std::vector<Node> nodes_;                                    // operands before their node, the root last
};

}  // namespace deburr
