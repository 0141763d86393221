#include "bounds/local_density.hpp"

#include <algorithm>

#include "bounds/local_density_pass.hpp"

namespace deburr {
namespace {

// boolean[i]: whether node i is a Boolean function of half-spaces, so that it may be part of a diagram.
void boolean_nodes(const DensityTree& tree, std::vector<char>& boolean) {
    boolean.clear();
    for (const TreeNode& n : tree.nodes) {
        switch (n.op) {
            case Op::half_space:
            case Op::conjunction:
            case Op::disjunction: boolean.push_back(true); break;
            case Op::constant: boolean.push_back(n.value == 0 || n.value == 1); break;
            case Op::complement: boolean.push_back(boolean[n.a]); break;
            default: boolean.push_back(false);
        }
    }
}

// root[i]: whether node i is the root of a Boolean part: its parent is an operator of the papers' arithmetic, or it has
// none.
void roots_of_boolean_parts(const DensityTree& tree, const std::vector<char>& boolean, std::vector<char>& root) {
    root.assign(tree.nodes.size(), false);
    root.back() = boolean.back();
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        const TreeNode& n = tree.nodes[i];
        if (boolean[i] || n.op == Op::constant || n.op == Op::half_space) continue;
        for (const int child : {n.a, n.b})
            if (child >= 0 && boolean[child]) root[child] = true;
    }
}

}  // namespace

LocalDensity::LocalDensity(const DensityTree& tree) : rounds_(tree.rounds) {
    if (tree.nodes.back().op == Op::convolution) {
        convolution_ = std::make_shared<BallConvolution>(tree);
        half_spaces_ = convolution_->half_spaces();
        return;
    }
    nodes_.reserve(tree.nodes.size());
    half_spaces_.reserve(tree.half_spaces.size());
    // These vectors are kept from one call to the next of a thread.
    // positive: a node is never below 0, as far as its operators tell
    thread_local std::vector<char> boolean, is_root, positive;
    thread_local std::vector<int> new_index;
    boolean_nodes(tree, boolean);
    roots_of_boolean_parts(tree, boolean, is_root);
    new_index.assign(tree.nodes.size(), -1);
    positive.assign(tree.nodes.size(), true);
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        const TreeNode& n = tree.nodes[i];
        const auto at = [&](int child) { return child < 0 ? -1 : new_index[child]; };
        bool operands = true;
        if (n.op != Op::half_space)
            for (const int child : {n.a, n.b}) operands &= child < 0 || positive[child];
        if (n.op == Op::constant)
            positive[i] = n.value >= 0;
        else if (n.op == Op::sum || n.op == Op::product)
            positive[i] = operands;
        else
            positive[i] = boolean[i];
        if (boolean[i]) {
            if (is_root[i]) new_index[i] = add_boolean(tree, int(i));
            continue;
        }
        switch (n.op) {
            case Op::constant: new_index[i] = add({Step::constant, -1, -1, n.value}); break;
            case Op::sum: new_index[i] = add({Step::sum, at(n.a), at(n.b)}); break;
            case Op::product: new_index[i] = add({Step::product, at(n.a), at(n.b)}); break;
            case Op::difference: new_index[i] = add({Step::difference, at(n.a), at(n.b), double(operands)}); break;
            case Op::complement: new_index[i] = add({Step::complement, at(n.a), -1, double(operands)}); break;
            default: break;
        }
    }
    for (const HalfSpace& h : half_spaces_) has_sharp_ |= h.radius == 0;
}

LocalDensity::LocalDensity(FieldPtr field) : field_(std::move(field)), half_spaces_(field_->planes()) {}

int LocalDensity::add(Node node) {
    nodes_.push_back(node);
    return int(nodes_.size()) - 1;
}

// Declared with the tree, so that whoever has one can evaluate it; defined here, where local densities are.
ValueGradient DensityTree::gradient_at(Vec3 x) const {
    return LocalDensity(prune(*this, Box{x, x}).tree).gradient_at(x);
}

double LocalDensity::at(Vec3 x) const {
    if (field_) return field_->at(x).value + 0.5;
    if (convolution_) return gradient_at(x).value;
    return evaluate_nodes<double>(nodes_, children_, [&](std::size_t i) { return half_spaces_[i].density(x); });
}

ValueGradient LocalDensity::gradient_at(Vec3 x) const {
    if (field_) {
        ValueGradient v = field_->at(x);
        v.value += 0.5;
        return v;
    }
    if (convolution_) {
        thread_local std::vector<double> alpha, slope;
        alpha.clear();
        for (const HalfSpace& h : half_spaces_) alpha.push_back(h.alpha(x));
        ValueGradient v{convolution_->at(alpha, slope)};
        for (std::size_t i = 0; i < alpha.size(); ++i)
            v.gradient += half_spaces_[i].normal * (slope[i] / half_spaces_[i].radius);
        return v;
    }
    return evaluate_nodes<ValueGradient>(nodes_, children_, [&](std::size_t i) -> ValueGradient {
        const HalfSpace& h = half_spaces_[i];
        const double alpha = h.alpha(x);
        if (h.radius == 0 || std::abs(alpha) >= 1) return {profile(alpha), Vec3(0.0)};
        return {profile(alpha), h.normal_at(x) * (profile_slope(alpha) / h.radius)};
    });
}

}  // namespace deburr
