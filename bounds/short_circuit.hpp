// A Boolean function of half-spaces as steps of short-circuit evaluation: each step tests one variable and names the
// next step, so that most of the function is never looked at.
//
// Steps only go forward. So a set of points can be sent through the steps just as a point can: a variable that cuts the
// set sends each part its own way (ball_arrangement.cpp).
#pragma once
#include <vector>

#include "bounds/density_tree.hpp"

namespace deburr {

/// A Boolean function as an expression tree: no node is an operand of two.
struct BooleanFunction {
    struct Node {
        Op op = Op::constant;  // constant, half_space, complement, conjunction or disjunction
        int a = -1, b = -1;    // operands; half_space: a is its index; constant: a is 0 or 1
        bool negated = false;  // half_space: its complement is meant
    };
    std::vector<Node> nodes;  // operands first, the root last
};

/// A variable, a variable's complement, or a truth value.
struct Literal {
    int variable = -1;  // −1: the literal is the truth value `same`
    /// Whether it is the variable itself rather than its complement.
    bool same = false;
};

/// The two ways in which an evaluation ends, in place of a step's index.
constexpr int ends_true = -1, ends_false = -2;

/// Tests one variable.
struct BooleanStep {
    int variable;
    int if_true, if_false;  // index of the next step, ends_true or ends_false
};

/// A function as steps: its value is found by going from step to step.
struct BooleanSteps {
    std::vector<BooleanStep> steps;
    int first = ends_false;  // index of the first step, ends_true or ends_false

    /// The function's value, where is_true(v) is that of variable v.
    template <class IsTrue>
    bool value(IsTrue is_true) const {
        int k = first;
        while (k >= 0) k = is_true(steps[k].variable) ? steps[k].if_true : steps[k].if_false;
        return k == ends_true;
    }
};

/// The steps of a function. Its variables are the half-spaces' indices.
BooleanSteps short_circuit(const BooleanFunction& function);

/// Replaces `left` by what is left of `function` when variables[v] is substituted for every variable v: only steps that
/// can be reached and that decide something. `left` must not be `function`.
void restrict_to(const BooleanSteps& function, const std::vector<Literal>& variables, BooleanSteps& left);

/// The most variables that relevant_variables() takes.
constexpr int max_tabulated = 10;

/// For each of `count` ≤ max_tabulated variables, whether the function's value depends on it; found from its truth
/// table.
std::vector<char> relevant_variables(const BooleanSteps& function, int count);

}  // namespace deburr
