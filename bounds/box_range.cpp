#include "bounds/box_range.hpp"

namespace deburr {
namespace {

Range product(Range a, Range b) {
    if (a.lo >= 0 && b.lo >= 0) return {a.lo * b.lo, a.hi * b.hi};
    const auto [lo, hi] = std::minmax({a.lo * b.lo, a.lo * b.hi, a.hi * b.lo, a.hi * b.hi});
    return {lo, hi};
}

Range combine(Op op, Range a, Range b) {
    switch (op) {
        case Op::sum: return {a.lo + b.lo, a.hi + b.hi};
        case Op::product: return product(a, b);
        case Op::difference: return {a.lo - b.hi, a.hi - b.lo};
        case Op::complement: return {1 - a.hi, 1 - a.lo};
        case Op::conjunction: return {std::max(0.0, a.lo + b.lo - 1), std::min(a.hi, b.hi)};
        case Op::disjunction: return {std::max(a.lo, b.lo), std::min(1.0, a.hi + b.hi)};
        default: return a;
    }
}

template <class OfHalfSpace>
Range range_of(const TreeNode& node, const std::vector<Range>& done, OfHalfSpace of_half_space) {
    if (node.op == Op::constant) return {node.value, node.value};
    if (node.op == Op::half_space) return of_half_space(std::size_t(node.a));
    return combine(node.op, done[std::size_t(node.a)],
                   node.b < 0 ? Range{} : done[std::size_t(node.b)]);
}

// Constant for a reason that holds wherever the half-spaces that are not saturated may lie. (That a
// range is a single value is no such reason: it is one over a box that is a point.)
bool is_constant(const TreeNode& node, const Range& range, const std::vector<char>& done) {
    const auto zero = [&] { return range.hi == 0; };
    const auto one = [&] { return range.lo == 1; };
    switch (node.op) {
        case Op::constant: return true;
        case Op::half_space: return zero() || one();
        case Op::complement: return done[std::size_t(node.a)];
        default: break;
    }
    const bool a = done[std::size_t(node.a)], b = done[std::size_t(node.b)];
    if (a && b) return true;
    if (node.op == Op::product || node.op == Op::conjunction) return (a || b) && range.lo == 0 && zero();
    if (node.op == Op::disjunction) return (a || b) && range.hi == 1 && one();
    return false;
}

template <class OfHalfSpace>
const std::vector<Range>& ranges_from(const DensityTree& tree, OfHalfSpace of_half_space) {
    thread_local std::vector<Range> done;
    done.clear();
    for (const TreeNode& node : tree.nodes) done.push_back(range_of(node, done, of_half_space));
    return done;
}

const std::vector<Range>& ranges(const DensityTree& tree, const Box& box) {
    return ranges_from(tree, [&](std::size_t i) { return density_range(tree.half_spaces[i], box); });
}

const std::vector<Range>& ranges(const DensityTree& tree, const std::vector<Range>& half_spaces) {
    return ranges_from(tree, [&](std::size_t i) { return half_spaces[i]; });
}

// Folds constants while it copies what the root reaches; children first, as in the original.
class Folding {
public:
    Folding(const DensityTree& from, const std::vector<Range>& ranges) : from_(from), ranges_(ranges) {}

    int size() {
        mark();
        int half_spaces = 0;
        for (std::size_t i = 0; i < from_.nodes.size(); ++i)
            half_spaces += needed_[i] && !constant_[i] && from_.nodes[i].op == Op::half_space;
        return half_spaces;
    }

    DensityTree run() {
        mark();
        place_.assign(from_.nodes.size(), -1);
        for (std::size_t i = 0; i < from_.nodes.size(); ++i)
            if (needed_[i]) place_[i] = copy(int(i));
        const int root = place_.back();
        if (root + 1 < int(to_.nodes.size())) to_.nodes.resize(std::size_t(root) + 1);
        return std::move(to_);
    }

private:
    bool constant(int i) const { return constant_[std::size_t(i)]; }
    bool is(int i, double value) const { return constant(i) && ranges_[std::size_t(i)].lo == value; }

    // The child that node i equals throughout, or −1.
    int same_as(int i) const {
        const TreeNode& n = from_.nodes[std::size_t(i)];
        switch (n.op) {
            case Op::sum:
            case Op::disjunction:
                if (is(n.a, 0)) return n.b;
                return is(n.b, 0) ? n.a : -1;
            case Op::product:
            case Op::conjunction:
                if (is(n.a, 1)) return n.b;
                return is(n.b, 1) ? n.a : -1;
            case Op::difference: return is(n.b, 0) ? n.a : -1;
            default: return -1;
        }
    }

    // From the root down: constants end a branch.
    void mark() {
        for (std::size_t i = 0; i < from_.nodes.size(); ++i)
            constant_.push_back(is_constant(from_.nodes[i], ranges_[i], constant_));
        needed_.assign(from_.nodes.size(), false);
        needed_.back() = true;
        for (int i = from_.root(); i >= 0; --i) {
            if (!needed_[std::size_t(i)] || constant(i)) continue;
            const TreeNode& n = from_.nodes[std::size_t(i)];
            if (n.op == Op::half_space || n.op == Op::constant) continue;
            if (const int same = same_as(i); same >= 0) {
                needed_[std::size_t(same)] = true;
                continue;
            }
            // 1 − b is kept as a complement, whose bounds are tighter than a difference's.
            if (!(n.op == Op::difference && is(n.a, 1))) needed_[std::size_t(n.a)] = true;
            if (n.b >= 0) needed_[std::size_t(n.b)] = true;
        }
    }

    int copy(int i) {
        TreeNode n = from_.nodes[std::size_t(i)];
        if (constant(i)) return add({Op::constant, -1, -1, ranges_[std::size_t(i)].lo, n.line});
        if (const int same = same_as(i); same >= 0) return place_[std::size_t(same)];
        if (n.op == Op::half_space) {
            to_.half_spaces.push_back(from_.half_spaces[std::size_t(n.a)]);
            n.a = int(to_.half_spaces.size()) - 1;
            return add(n);
        }
        if (n.op == Op::difference && is(n.a, 1))
            return add({Op::complement, place_[std::size_t(n.b)], -1, 0, n.line});
        n.a = place_[std::size_t(n.a)];
        if (n.b >= 0) n.b = place_[std::size_t(n.b)];
        return add(n);
    }

    int add(TreeNode node) {
        to_.nodes.push_back(node);
        return int(to_.nodes.size()) - 1;
    }

    const DensityTree& from_;
    const std::vector<Range>& ranges_;
    std::vector<char> constant_, needed_;
    std::vector<int> place_;
    DensityTree to_;
};

}  // namespace

Range distance_range(const HalfSpace& h, const Box& box) {
    double lo = -h.offset, hi = -h.offset;
    for (int k = 0; k < 3; ++k) {
        const double n = h.normal[k];
        if (n == 0) continue;  // 0·∞ is no number
        lo += n * (n > 0 ? box.lo[k] : box.hi[k]);
        hi += n * (n > 0 ? box.hi[k] : box.lo[k]);
    }
    return {lo, hi};
}

Range density_range(const HalfSpace& h, const Box& box) {
    const Range d = distance_range(h, box);
    return {profile(h.alpha_at(d.hi)), profile(h.alpha_at(d.lo))};
}

Range density_range(const DensityTree& tree, const Box& box) { return ranges(tree, box).back(); }

Range density_range(const DensityTree& tree, const std::vector<Range>& half_spaces) {
    return ranges(tree, half_spaces).back();
}

LocalSize local_size(const DensityTree& tree, const Box& box) {
    const std::vector<Range>& all = ranges(tree, box);
    return {all.back(), Folding(tree, all).size()};
}

Pruned prune(const DensityTree& tree, const Box& box) {
    const std::vector<Range>& all = ranges(tree, box);
    return {Folding(tree, all).run(), all.back()};
}

Pruned prune(const DensityTree& tree, const std::vector<Range>& half_spaces) {
    const std::vector<Range>& all = ranges(tree, half_spaces);
    return {Folding(tree, all).run(), all.back()};
}

}  // namespace deburr
