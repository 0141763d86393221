// A Boolean function of half-spaces as steps of short-circuit evaluation: each step looks at one variable and says
// which later step is next, so that most of a function is never looked at.
//
// A step goes forward only. So a set of points can be sent through the steps as well as a point: a variable that cuts
// it sends either part its own way (ball_arrangement.cpp).
#pragma once
#include <vector>

#include "bounds/density_tree.hpp"

namespace deburr {

/// A tree: no node is the operand of two.
struct BooleanFunction {
    struct Node {
        Op op = Op::constant;  // or half_space, complement, conjunction, disjunction
        int a = -1, b = -1;    // operands; half_space: a is its index; constant: a is 0 or 1
        bool negated = false;  // half_space: its complement is meant
    };
    std::vector<Node> nodes;  // operands first, the root last
};

/// A truth value, or a variable, or a variable's complement.
struct Literal {
    int variable = -1;  // −1: none, and the literal is the value `same`
    bool same = false;
};

constexpr int ends_true = -1, ends_false = -2;

struct BooleanStep {
    int variable;
    int if_true, if_false;  // index of the next step, or how the evaluation ends
};

/// A function's value is found by going from step to step.
struct BooleanSteps {
    std::vector<BooleanStep> steps;
    int first = ends_false;  // index of a step, or how the evaluation ends

    /// The value where `is_true` tells every variable's.
    template <class IsTrue>
    bool value(IsTrue is_true) const {
        int k = first;
        while (k >= 0) k = is_true(steps[k].variable) ? steps[k].if_true : steps[k].if_false;
        return k == ends_true;
    }
};

/// The steps of a function, whose variables are its half-spaces.
BooleanSteps short_circuit(const BooleanFunction& function);

/// Replaces `left` by what is left of `function` when every variable is the literal with its index: steps that can be
/// reached and that decide something.
void restrict_to(const BooleanSteps& function, const std::vector<Literal>& variables, BooleanSteps& left);

constexpr int max_tabulated = 10;

/// Which of `count` variables, max_tabulated at most, the function's value depends on; found from its truth table.
std::vector<char> relevant_variables(const BooleanSteps& function, int count);

}  // namespace deburr
