#include "bounds/short_circuit.hpp"

#include <cassert>
#include <cstdint>

namespace deburr {

// Every operand is given the steps at which evaluation continues if it is true and if it is false, from the root down:
// a conjunction continues with its second operand only where the first is true. Half-spaces and constants (steps that
// always go one way) are numbered first, so that every operand's first step is known. Both passes keep a stack of their
// own, because scenes write chains as long as their loops.
BooleanSteps short_circuit(const BooleanFunction& function) {
    const auto& nodes = function.nodes;
    struct Part {
        int node, if_true, if_false;
    };
    std::vector<int> first(nodes.size(), -1), pending{int(nodes.size()) - 1}, order;
    while (!pending.empty()) {
        const int i = pending.back();
        pending.pop_back();
        order.push_back(i);
        for (const int child : {nodes[i].b, nodes[i].a})
            if (nodes[i].op != Op::half_space && nodes[i].op != Op::constant && child >= 0) pending.push_back(child);
    }
    const auto is_leaf = [&](int i) { return nodes[i].op == Op::half_space || nodes[i].op == Op::constant; };
    int leaves = 0;
    for (const int i : order)
        if (is_leaf(i)) first[i] = leaves++;
    for (std::size_t k = order.size(); k-- > 0;)
        if (const int i = order[k]; !is_leaf(i)) first[i] = first[nodes[i].a];

    std::vector<Part> parts{{int(nodes.size()) - 1, ends_true, ends_false}};
    BooleanSteps all;
    all.first = 0;
    all.steps.resize(std::size_t(leaves));
    while (!parts.empty()) {
        const auto [i, if_true, if_false] = parts.back();
        parts.pop_back();
        const auto& n = nodes[i];
        switch (n.op) {
            case Op::half_space:
                all.steps[first[i]] =
                    n.negated ? BooleanStep{n.a, if_false, if_true} : BooleanStep{n.a, if_true, if_false};
                break;
            case Op::complement: parts.push_back({n.a, if_false, if_true}); break;
            case Op::conjunction:
                parts.push_back({n.a, first[n.b], if_false});
                parts.push_back({n.b, if_true, if_false});
                break;
            case Op::disjunction:
                parts.push_back({n.a, if_true, first[n.b]});
                parts.push_back({n.b, if_true, if_false});
                break;
            default: {
                const int next = n.a != 0 ? if_true : if_false;
                all.steps[first[i]] = {0, next, next};
            }
        }
    }
    return all;
}

void restrict_to(const BooleanSteps& function, const std::vector<Literal>& variables, BooleanSteps& left) {
    // Backwards: entry[k] is where step k leads, with steps that decide nothing skipped.
    thread_local std::vector<BooleanStep> open;
    thread_local std::vector<int> entry, number;
    const auto& steps = function.steps;
    const int count = int(steps.size());
    open.resize(steps.size());
    entry.resize(steps.size());
    const auto target = [&](int k) { return k < 0 ? k : entry[k]; };
    for (int k = count; k-- > 0;) {
        const BooleanStep& s = steps[k];
        const int if_true = target(s.if_true), if_false = target(s.if_false);
        if (if_true == if_false) {
            entry[k] = if_true;
            continue;
        }
        const Literal literal = variables[s.variable];
        if (literal.variable < 0) {
            entry[k] = literal.same ? if_true : if_false;
            continue;
        }
        open[k] = literal.same ? BooleanStep{literal.variable, if_true, if_false}
                               : BooleanStep{literal.variable, if_false, if_true};
        entry[k] = k;
    }
    // Forwards: the steps that can be reached are numbered.
    left.steps.clear();
    left.first = target(function.first);
    if (left.first < 0) return;
    constexpr int unreached = -1, reached = 0;
    number.assign(steps.size(), unreached);
    number[left.first] = reached;
    for (int k = left.first; k < count; ++k) {
        if (number[k] == unreached) continue;
        number[k] = int(left.steps.size());
        left.steps.push_back(open[k]);
        for (const int next : {open[k].if_true, open[k].if_false})
            if (next >= 0) number[next] = reached;
    }
    for (BooleanStep& s : left.steps)
        for (int* next : {&s.if_true, &s.if_false})
            if (*next >= 0) *next = number[*next];
    left.first = 0;
}

std::vector<char> relevant_variables(const BooleanSteps& function, int count) {
    // Truth tables: bit k of word v is the value of variable v in assignment k; further variables select the word.
    constexpr int in_a_word = 6;
    constexpr std::uint64_t assignments[in_a_word] = {0xaaaaaaaaaaaaaaaa, 0xcccccccccccccccc, 0xf0f0f0f0f0f0f0f0,
                                                      0xff00ff00ff00ff00, 0xffff0000ffff0000, 0xffffffff00000000};
    constexpr std::uint64_t all = ~std::uint64_t(0);
    assert(count <= max_tabulated);
    std::vector<char> relevant(std::size_t(count), false);
    if (function.first < 0) return relevant;

    const std::size_t words = std::size_t(1) << std::max(0, count - in_a_word);
    thread_local std::vector<std::uint64_t> tables;  // of every step, one after the other
    tables.resize(function.steps.size() * words);
    for (std::size_t k = function.steps.size(); k-- > 0;) {
        const BooleanStep& s = function.steps[k];
        for (std::size_t w = 0; w < words; ++w) {
            const auto of = [&](int next) {
                return next == ends_true ? all : next == ends_false ? 0 : tables[next * words + w];
            };
            const std::uint64_t truth = s.variable < in_a_word              ? assignments[s.variable]
                                        : w >> (s.variable - in_a_word) & 1 ? all
                                                                            : 0;
            tables[k * words + w] = (truth & of(s.if_true)) | (~truth & of(s.if_false));
        }
    }
    for (int v = 0; v < count; ++v)
        for (std::size_t w = 0; w < words && !relevant[v]; ++w) {
            const std::uint64_t here = tables[w];
            if (v < in_a_word)
                relevant[v] = (here & assignments[v]) >> (1 << v) != (here & ~assignments[v]);
            else
                relevant[v] = here != tables[w | std::size_t(1) << (v - in_a_word)];
        }
    return relevant;
}

}  // namespace deburr
