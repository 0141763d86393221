// A rounded density as POV-Ray evaluates it: a formula of x, y and z, and a proven bound of its slope.
//
// The papers' arithmetic is written as it stands; a Boolean part is its decision diagram multiplied
// out, Σ pⱼ cⱼ decision by decision (bounds/decision_diagram.hpp). A diagram's shared nodes are written
// once per use, as POV-Ray's functions have no variables: what grows too long is not supported.
#pragma once
#include <string>
#include <vector>

#include "bounds/box_range.hpp"

namespace deburr {

/// The declaration of ρ(α), as Rho, in a file of POV-Ray: by cases, or clamped by min and max.
std::string pov_profile(bool by_cases);

class PovField {
public:
    /// No half-space of `tree` is sharp. Throws TooEntangled with the line if a diagram is too large.
    explicit PovField(const DensityTree& tree, int line = 0);

    /// ρ. Throws UnsupportedError if it has more than `max_terms` half-spaces, counted once per use.
    std::string formula() const;
    static constexpr double max_terms = 20'000;

    /// |∇ρ| is nowhere in the finite box greater than this. Boxes are halved where it may be, until
    /// the bound is within 1 % of a slope that was met or the work is spent.
    double greatest_slope(const Box& box) const;

private:
    enum class Step : unsigned char { constant, half_space, sum, product, difference, decision };
    struct Node {
        Step step = Step::constant;
        double value = 0;                   // constant
        int a = -1, b = -1;                 // operands; half_space: a is its index
        std::vector<int> planes, children;  // decision: as in Decision, planes by index
    };
    struct Slopes;

    int add_boolean(const DensityTree& tree, int root);
    int add(Node node);
    std::string decision(const Node& node, const std::vector<std::string>& done) const;
    Slopes slopes(const Box& box) const;

    int line_;
    std::vector<HalfSpace> half_spaces_;
    std::shared_ptr<const std::deque<RoundCoordinate>> rounds_;  // what they point to
    std::vector<Node> nodes_;                                    // operands first, the root last
};

}  // namespace deburr
