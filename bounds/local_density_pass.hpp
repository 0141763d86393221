// One pass over the nodes of a local density in three arithmetics: values alone, values with gradients, and values with
// slopes along a ray.
//
// A decision node with thresholds τ₀ … τₘ₋₁ and children c₀ … cₘ has the value Σ pⱼ cⱼ, where
// pⱼ = F(τⱼ) − F(τⱼ₋₁). Ordered by F that is
//
//     V = cₘ + Σⱼ Fⱼ (cⱼ − cⱼ₊₁),
//
// affine in every Fⱼ.
#pragma once
#include <vector>

#include "bounds/density_tree.hpp"
#include "bounds/ray_bounds.hpp"
#include "bounds/thread_memory.hpp"

namespace deburr {

inline ValueGradient operator+(const ValueGradient& a, const ValueGradient& b) {
    return {a.value + b.value, a.gradient + b.gradient};
}
inline ValueGradient operator-(const ValueGradient& a, const ValueGradient& b) {
    return {a.value - b.value, a.gradient - b.gradient};
}
inline ValueGradient operator*(const ValueGradient& a, const ValueGradient& b) {
    return {a.value * b.value, a.value * b.gradient + b.value * a.gradient};
}

inline ValueSlope operator+(ValueSlope a, ValueSlope b) { return {a.value + b.value, a.slope + b.slope}; }
inline ValueSlope operator-(ValueSlope a, ValueSlope b) { return {a.value - b.value, a.slope - b.slope}; }
inline ValueSlope operator*(ValueSlope a, ValueSlope b) {
    return {a.value * b.value, a.value * b.slope + b.value * a.slope};
}

// Where a half-space's density is 0 with slope 0, a decision does not depend on the children that it leads to.
inline bool is_zero(double v) { return v == 0; }
inline bool is_zero(const ValueGradient& v) { return v.value == 0 && v.gradient == Vec3(0.0); }
inline bool is_zero(ValueSlope v) { return v.value == 0 && v.slope == 0; }

/// The value of the last node, as a T: double, ValueGradient or ValueSlope. leaf(i) returns the density of half-space i
/// as a T.
template <class T, class Node, class Leaf>
T evaluate_nodes(const std::vector<Node>& nodes, const std::vector<int>& children, Leaf leaf) {
    using Step = decltype(Node::step);
    T* const done = memory_for<T>(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Node& n = nodes[i];
        const auto at = [&](int child) -> const T& { return done[child]; };
        switch (n.step) {
            case Step::constant: done[i] = T{n.value}; break;
            case Step::half_space: done[i] = leaf(std::size_t(n.a)); break;
            case Step::sum: done[i] = at(n.a) + at(n.b); break;
            case Step::product: done[i] = at(n.a) * at(n.b); break;
            case Step::difference: done[i] = at(n.a) - at(n.b); break;
            case Step::complement: done[i] = T{1.0} - at(n.a); break;
            case Step::decision: {
                const int* thresholds = &children[n.a];
                const int* operands = thresholds + n.b;
                T sum = at(operands[n.b]);
                for (int j = 0; j < n.b; ++j) {
                    const T share = leaf(std::size_t(thresholds[j]));
                    if (!is_zero(share)) sum = sum + share * (at(operands[j]) - at(operands[j + 1]));
                }
                done[i] = sum;
                break;
            }
        }
    }
    return done[nodes.size() - 1];
}

}  // namespace deburr
