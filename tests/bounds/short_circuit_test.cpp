// Boolean functions as steps with short circuits, against their evaluation node by node.
#include "bounds/short_circuit.hpp"

#include "catch.hpp"
#include "random_case.hpp"

using namespace deburr;

namespace {

// A random function of the half-spaces 0 … count − 1; some occur more than once, and some operands are constants.
BooleanFunction random_function(Gen& g, int count) {
    BooleanFunction f;
    std::vector<int> roots;
    const auto add = [&](BooleanFunction::Node node) {
        f.nodes.push_back(node);
        return int(f.nodes.size()) - 1;
    };
    for (int k = 0; k < count + 2; ++k)
        roots.push_back(g.chance(0.1) ? add({Op::constant, g.below(2)})
                                      : add({Op::half_space, g.below(count), -1, g.chance(0.3)}));
    while (roots.size() > 1) {
        const auto take = [&] {
            const std::size_t at = std::size_t(g.below(int(roots.size())));
            const int root = roots[at];
            roots.erase(roots.begin() + std::ptrdiff_t(at));
            return root;
        };
        const int a = take(), b = take();
        const int both = add({g.chance(0.5) ? Op::conjunction : Op::disjunction, a, b});
        roots.push_back(g.chance(0.2) ? add({Op::complement, both}) : both);
    }
    return f;
}

bool plain_value(const BooleanFunction& f, const std::vector<char>& is_true) {
    std::vector<char> value;
    for (const auto& n : f.nodes) switch (n.op) {
            case Op::half_space: value.push_back(bool(is_true[n.a]) != n.negated); break;
            case Op::complement: value.push_back(!value[n.a]); break;
            case Op::conjunction: value.push_back(value[n.a] && value[n.b]); break;
            case Op::disjunction: value.push_back(value[n.a] || value[n.b]); break;
            default: value.push_back(n.a != 0);
        }
    return value.back();
}

std::vector<char> assignment(unsigned bits, int count) {
    std::vector<char> is_true;
    for (int v = 0; v < count; ++v) is_true.push_back(bits >> v & 1);
    return is_true;
}

}  // namespace

TEST_CASE("steps go forward, are all reached, and end with the function's value") {
    for (auto seed : seeds(2'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const int count = 1 + g.below(8);
        const BooleanFunction f = random_function(g, count);
        std::vector<Literal> themselves;
        for (int v = 0; v < count; ++v) themselves.push_back({v, true});
        BooleanSteps steps;
        restrict_to(short_circuit(f), themselves, steps);
        std::vector<char> reached(steps.steps.size(), false);
        if (!reached.empty()) reached[0] = true;
        for (int k = 0; k < int(steps.steps.size()); ++k) {
            CHECK(reached[k]);
            for (const int next : {steps.steps[k].if_true, steps.steps[k].if_false}) {
                CHECK((next < 0 || next > k));
                if (next >= 0) reached[next] = true;
            }
        }
        for (unsigned bits = 0; bits < 1U << count; ++bits) {
            const std::vector<char> is_true = assignment(bits, count);
            const auto of = [&](int v) { return bool(is_true[v]); };
            CHECK(short_circuit(f).value(of) == plain_value(f, is_true));
            CHECK(steps.value(of) == plain_value(f, is_true));
        }
    }
}

TEST_CASE("what is left of a function has its value wherever the known variables are as they are known") {
    int decided = 0;
    for (auto seed : seeds(2'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const int count = 1 + g.below(6), variables = 1 + g.below(4);
        const BooleanFunction f = random_function(g, count);
        std::vector<Literal> literals;
        for (int i = 0; i < count; ++i)
            literals.push_back(g.chance(0.4) ? Literal{-1, g.chance(0.5)} : Literal{g.below(variables), g.chance(0.5)});
        BooleanSteps left;
        restrict_to(short_circuit(f), literals, left);
        decided += left.first < 0;
        for (unsigned bits = 0; bits < 1U << variables; ++bits) {
            const std::vector<char> is_true = assignment(bits, variables);
            std::vector<char> of_half_spaces;
            for (const Literal l : literals)
                of_half_spaces.push_back(l.variable < 0 ? l.same : bool(is_true[l.variable]) == l.same);
            CHECK(left.value([&](int v) { return bool(is_true[v]); }) == plain_value(f, of_half_spaces));
        }
    }
    CHECK(decided > 200);
}

TEST_CASE("relevant variables are those that change the value somewhere", "[slow]") {
    int irrelevant = 0;
    for (auto seed : seeds(1'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const int count = 1 + g.below(max_tabulated);
        const BooleanFunction f = random_function(g, count);
        const BooleanSteps steps = short_circuit(f);
        const std::vector<char> relevant = relevant_variables(steps, count);
        for (int v = 0; v < count; ++v) {
            bool changes = false;
            for (unsigned bits = 0; bits < 1U << count && !changes; ++bits)
                changes = plain_value(f, assignment(bits, count)) != plain_value(f, assignment(bits ^ 1U << v, count));
            CHECK(bool(relevant[v]) == changes);
            irrelevant += !changes;
        }
    }
    CHECK(irrelevant > 500);
}

TEST_CASE("a chain of 300,000 operands becomes steps without recursion") {
    BooleanFunction f;
    f.nodes.push_back({Op::half_space, 0});
    constexpr int length = 300'000;
    for (int k = 1; k < length; ++k) {
        f.nodes.push_back({Op::half_space, k});
        const int last = int(f.nodes.size()) - 1;
        f.nodes.push_back({k % 2 ? Op::conjunction : Op::disjunction, last - 1, last});
    }
    const BooleanSteps steps = short_circuit(f);
    CHECK(steps.steps.size() == std::size_t(length));
    CHECK(steps.value([](int) { return true; }));
    CHECK_FALSE(steps.value([](int) { return false; }));
}
