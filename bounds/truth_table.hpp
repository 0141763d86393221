// A Boolean function of half-spaces, and its truth while they are flipped one after the other.
//
// Functions of few variables are truth tables, made 64 assignments at a time; others keep the truth
// of every node, and a flip changes what lies above it.
#pragma once
#include <cstdint>
#include <vector>

#include "bounds/density_tree.hpp"

namespace deburr {

struct BooleanFunction {
    struct Node {
        Op op = Op::constant;  // or half_space, complement, conjunction, disjunction
        int a = -1, b = -1;    // operands; half_space: a is its index; constant: a is 0 or 1
        bool negated = false;  // half_space: its complement is meant
    };
    std::vector<Node> nodes;  // operands first, the root last
};

/// What is known of a half-space: that it is true or false, or that it equals a variable or the
/// variable's complement.
struct Literal {
    int variable = -1;  // −1: none, and the half-space is `same`
    bool same = false;
};

class TruthTable {
public:
    static constexpr int max_tabulated = 10;

    /// Variables 0 … count − 1, all false.
    void set(const BooleanFunction& function, const std::vector<Literal>& half_spaces, int count);

    bool value() const {
        return count_ <= max_tabulated ? words_[table_ + (state_ >> 6)] >> (state_ & 63) & 1 : bool(truth_.back());
    }
    bool operator[](int variable) const {
        return count_ <= max_tabulated ? state_ >> variable & 1 : bool(bits_[variable]);
    }
    void flip(int variable);
    void put(int variable, bool value) {
        if ((*this)[variable] != value) flip(variable);
    }
    /// False if the value never depends on it, as far as that can be told at a glance.
    bool depends_on(int variable) const;

private:
    bool of_operands(std::size_t node) const;

    int count_ = 0;
    std::size_t table_ = 0;             // of the root, in words_
    std::uint64_t state_ = 0;           // the assignment's number
    std::vector<std::uint64_t> words_;  // node after node
    // Beyond the table.
    std::vector<BooleanFunction::Node> nodes_;
    std::vector<char> truth_, bits_;
    std::vector<int> parent_;
    std::vector<std::vector<int>> uses_;  // of each variable, by half-space nodes
};

/// Which half-spaces the function can depend on once some are known; `known`: 0, 1, or 2 if not.
void mark_open(const BooleanFunction& function, const std::vector<char>& known, std::vector<char>& open);

}  // namespace deburr
