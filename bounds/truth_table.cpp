#include "bounds/truth_table.hpp"

namespace deburr {
namespace {

// Bit k of word v is the truth of variable v in assignment k; further variables number the words.
constexpr int in_a_word = 6;
constexpr std::uint64_t assignments[in_a_word] = {0xaaaaaaaaaaaaaaaa, 0xcccccccccccccccc, 0xf0f0f0f0f0f0f0f0,
                                                  0xff00ff00ff00ff00, 0xffff0000ffff0000, 0xffffffff00000000};

std::uint64_t all(bool value) { return value ? ~std::uint64_t(0) : 0; }

}  // namespace

void TruthTable::set(const BooleanFunction& function, const std::vector<Literal>& half_spaces, int count) {
    const auto& nodes = function.nodes;
    count_ = count;
    state_ = 0;
    if (count <= max_tabulated) {
        const std::size_t many = std::size_t(1) << std::max(0, count - in_a_word);
        words_.resize(nodes.size() * many);
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const auto& n = nodes[i];
            std::uint64_t* to = &words_[i * many];
            const auto of = [&](int child) { return &words_[std::size_t(child) * many]; };
            if (n.op == Op::half_space) {
                const Literal l = half_spaces[n.a];
                const bool same = l.same != n.negated;
                for (std::size_t w = 0; w < many; ++w) {
                    if (l.variable < 0)
                        to[w] = all(same);
                    else if (l.variable < in_a_word)
                        to[w] = assignments[l.variable] ^ all(!same);
                    else
                        to[w] = all((w >> (l.variable - in_a_word) & 1) == same);
                }
            } else if (n.op == Op::complement) {
                for (std::size_t w = 0; w < many; ++w) to[w] = ~of(n.a)[w];
            } else if (n.op == Op::conjunction) {
                for (std::size_t w = 0; w < many; ++w) to[w] = of(n.a)[w] & of(n.b)[w];
            } else if (n.op == Op::disjunction) {
                for (std::size_t w = 0; w < many; ++w) to[w] = of(n.a)[w] | of(n.b)[w];
            } else {
                for (std::size_t w = 0; w < many; ++w) to[w] = all(n.a != 0);
            }
        }
        table_ = words_.size() - many;
        return;
    }
    nodes_ = nodes;
    truth_.assign(nodes.size(), false);
    bits_.assign(std::size_t(count), false);
    parent_.assign(nodes.size(), -1);
    uses_.resize(std::max(uses_.size(), std::size_t(count)));
    for (auto& uses : uses_) uses.clear();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const auto& n = nodes[i];
        if (n.op == Op::half_space) {
            const Literal l = half_spaces[n.a];
            truth_[i] = l.variable < 0 ? l.same != n.negated : l.same == n.negated;
            if (l.variable >= 0) uses_[l.variable].push_back(int(i));
            continue;
        }
        if (n.op != Op::constant)
            for (const int child : {n.a, n.b})
                if (child >= 0) parent_[child] = int(i);
        truth_[i] = of_operands(i);
    }
}

bool TruthTable::of_operands(std::size_t node) const {
    const auto& n = nodes_[node];
    const auto at = [&](int child) -> bool { return truth_[child]; };
    switch (n.op) {
        case Op::complement: return !at(n.a);
        case Op::conjunction: return at(n.a) && at(n.b);
        case Op::disjunction: return at(n.a) || at(n.b);
        default: return n.a != 0;
    }
}

void TruthTable::flip(int variable) {
    if (count_ <= max_tabulated) {
        state_ ^= std::uint64_t(1) << variable;
        return;
    }
    bits_[variable] ^= 1;
    for (const int use : uses_[variable]) {
        truth_[use] ^= 1;
        for (int i = parent_[use]; i >= 0; i = parent_[i]) {
            const bool now = of_operands(std::size_t(i));
            if (now == bool(truth_[i])) break;
            truth_[i] = now;
        }
    }
}

bool TruthTable::depends_on(int variable) const {
    if (count_ > max_tabulated) return true;
    const std::size_t many = words_.size() - table_;
    for (std::size_t w = 0; w < many; ++w) {
        const std::uint64_t here = words_[table_ + w];
        if (variable < in_a_word) {
            const std::uint64_t with = assignments[variable];
            if ((here & with) >> (1 << variable) != (here & ~with)) return true;
        } else if (here != words_[table_ + (w | std::size_t(1) << (variable - in_a_word))]) {
            return true;
        }
    }
    return false;
}

void mark_open(const BooleanFunction& function, const std::vector<char>& known, std::vector<char>& open) {
    constexpr char unknown = 2;
    const auto& nodes = function.nodes;
    thread_local std::vector<char> value, needed;
    value.resize(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const auto& n = nodes[i];
        const auto at = [&](int child) { return value[child]; };
        const auto absorbing = [&](char by, char rest) -> char {
            if (at(n.a) == by || at(n.b) == by) return by;
            return at(n.a) == unknown || at(n.b) == unknown ? unknown : rest;
        };
        switch (n.op) {
            case Op::half_space: {
                const char k = known[n.a];
                value[i] = k == unknown ? unknown : char((k != 0) != n.negated);
                break;
            }
            case Op::complement: value[i] = at(n.a) == unknown ? unknown : char(!at(n.a)); break;
            case Op::conjunction: value[i] = absorbing(0, 1); break;
            case Op::disjunction: value[i] = absorbing(1, 0); break;
            default: value[i] = n.a != 0;
        }
    }
    open.assign(known.size(), false);
    needed.assign(nodes.size(), false);
    needed.back() = true;
    for (std::size_t i = nodes.size(); i-- > 0;) {
        if (!needed[i] || value[i] != unknown) continue;
        const auto& n = nodes[i];
        if (n.op == Op::half_space) {
            open[n.a] = true;
            continue;
        }
        for (const int child : {n.a, n.b})
            if (child >= 0) needed[child] = true;
    }
}

}  // namespace deburr
