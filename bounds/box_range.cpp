#include "bounds/box_range.hpp"

#include <algorithm>

namespace deburr {
namespace {

// Range of a node's ρ over the region, and whether ρ is provably constant there because enough half-spaces are
// saturated (0 or 1), wherever the others lie. A range that is a single value does not imply that: over a box that is a
// point every range is one.
struct NodeRange : Range {
    bool constant = false;
};

bool is_constant(Op op, const Range& range, const NodeRange& a, const NodeRange& b) {
    const auto zero = [&] { return range.lo == 0 && range.hi == 0; };
    const auto one = [&] { return range.lo == 1 && range.hi == 1; };
    if (op == Op::complement || op == Op::convolution) return a.constant;
    if (a.constant && b.constant) return true;
    if (op == Op::product || op == Op::conjunction) return (a.constant || b.constant) && zero();
    if (op == Op::disjunction) return (a.constant || b.constant) && one();
    return false;
}

template <class OfHalfSpace, class Misses>
const std::vector<NodeRange>& ranges_from(const DensityTree& tree, OfHalfSpace of_half_space, Misses misses) {
    thread_local std::vector<NodeRange> own;
    own.resize(tree.nodes.size());
    NodeRange* const done = own.data();
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        const TreeNode& n = tree.nodes[i];
        if (n.op == Op::constant) {
            done[i] = {{n.value, n.value}, true};
        } else if (n.op == Op::half_space) {
            const Range r = of_half_space(std::size_t(n.a));
            done[i] = {r, r.hi == 0 || r.lo == 1};
        } else if (n.support >= 0 && misses(tree.supports[n.support])) {
            done[i] = {{0, 0}, true};
        } else {
            const NodeRange a = done[n.a], b = n.b < 0 ? NodeRange{} : done[n.b];
            const Range r = combine(n.op, a, b);
            done[i] = {r, is_constant(n.op, r, a, b)};
        }
    }
    return own;
}

const std::vector<NodeRange>& ranges(const DensityTree& tree, const Box& box) {
    return ranges_from(
        tree, [&](std::size_t i) { return density_range(tree.half_spaces[i], box); },
        [&](const Box& support) { return intersection(support, box).empty(); });
}

const std::vector<NodeRange>& ranges(const DensityTree& tree, const std::vector<Range>& half_spaces) {
    return ranges_from(
        tree, [&](std::size_t i) { return half_spaces[i]; }, [](const Box&) { return false; });
}

// Copies the part of a tree that the root needs, with constant nodes folded away; the order stays, children first.
class Folding {
public:
    Folding(const DensityTree& from, const std::vector<NodeRange>& ranges)
        : from_(from), ranges_(ranges), needed_(memory().needed), new_index_(memory().new_index) {
        mark();
    }

    int size() {
        int half_spaces = 0;
        for (std::size_t i = 0; i < from_.nodes.size(); ++i)
            half_spaces += needed_[i] && !constant(int(i)) && from_.nodes[i].op == Op::half_space;
        return half_spaces;
    }

    DensityTree run() {
        new_index_.assign(from_.nodes.size(), -1);
        to_.nodes.reserve(std::size_t(std::count(needed_.begin(), needed_.end(), true)));
        to_.half_spaces.reserve(std::size_t(size()));
        for (std::size_t i = 0; i < from_.nodes.size(); ++i)
            if (needed_[i]) new_index_[i] = copy(int(i));
        const int root = new_index_.back();
        to_.ball = from_.ball;
        to_.rounds = from_.rounds;
        if (root + 1 < int(to_.nodes.size())) to_.nodes.resize(std::size_t(root) + 1);
        return std::move(to_);
    }

private:
    bool constant(int i) const { return ranges_[i].constant; }
    bool is(int i, double value) const { return constant(i) && ranges_[i].lo == value; }

    // The child that node i equals throughout the region, or −1.
    int same_as(int i) const {
        const TreeNode& n = from_.nodes[i];
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

    // Marks the nodes that the root needs, from the root down; a constant node needs no operands.
    void mark() {
        const std::size_t count = from_.nodes.size();
        needed_.assign(count, false);
        for (int i = from_.root(); i >= 0; --i) {
            if (std::size_t(i) + 1 == count) needed_[i] = true;
            if (!needed_[i] || constant(i)) continue;
            const TreeNode& n = from_.nodes[i];
            if (n.op == Op::half_space || n.op == Op::constant) continue;
            if (const int same = same_as(i); same >= 0) {
                needed_[same] = true;
                continue;
            }
            // 1 − b becomes a complement, whose bounds are tighter than a difference's.
            if (!(n.op == Op::difference && is(n.a, 1))) needed_[n.a] = true;
            if (n.b >= 0) needed_[n.b] = true;
        }
    }

    int copy(int i) {
        TreeNode n = from_.nodes[i];
        if (constant(i)) return add({Op::constant, -1, -1, ranges_[i].lo, n.line});
        if (const int same = same_as(i); same >= 0) return new_index_[same];
        if (n.op == Op::half_space) {
            to_.half_spaces.push_back(from_.half_spaces[n.a]);
            n.a = int(to_.half_spaces.size()) - 1;
            n.support = -1;
            return add(n);
        }
        if (n.op == Op::difference && is(n.a, 1)) return add({Op::complement, new_index_[n.b], -1, 0, n.line});
        n.a = new_index_[n.a];
        if (n.b >= 0) n.b = new_index_[n.b];
        if (n.support >= 0) {
            to_.supports.push_back(from_.supports[n.support]);
            n.support = int(to_.supports.size()) - 1;
        }
        return add(n);
    }

    int add(TreeNode node) {
        to_.nodes.push_back(node);
        return int(to_.nodes.size()) - 1;
    }

    // Buffers that a thread keeps from one folding to the next.
    struct Memory {
        std::vector<char> needed;
        std::vector<int> new_index;
    };
    static Memory& memory() {
        thread_local Memory own;
        return own;
    }

    const DensityTree& from_;
    const std::vector<NodeRange>& ranges_;
    std::vector<char>& needed_;
    std::vector<int>& new_index_;
    DensityTree to_;
};

}  // namespace

namespace {

// Range of a node in each of K boxes, whether it is constant there, and how many half-spaces are left below it: the sum
// of its operands', as a constant has none and whatever is folded away is constant.
template <int K>
struct NodeSizes {
    double lo[K], hi[K];
    int half_spaces[K];
    bool constant[K];

    NodeRange range(int k) const { return {{lo[k], hi[k]}, constant[k]}; }
    void set(int k, const NodeRange& r, int count) {
        lo[k] = r.lo;
        hi[k] = r.hi;
        constant[k] = r.constant;
        half_spaces[k] = r.constant ? 0 : count;
    }
};

// density_range() in K boxes at a time, with the same order of operations, so with the same bits.
template <int K>
void set_half_space(NodeSizes<K>& to, const HalfSpace& h, const Box* boxes) {
    if (h.round) {
        for (int k = 0; k < K; ++k) {
            const Range r = density_range(h, boxes[k]);
            to.set(k, {r, r.hi == 0 || r.lo == 1}, 1);
        }
        return;
    }
    double near[K], far[K];
    for (int k = 0; k < K; ++k) near[k] = far[k] = -h.offset;
    for (int axis = 0; axis < 3; ++axis) {
        const double n = h.normal[axis];
        if (n == 0) continue;
        for (int k = 0; k < K; ++k) {
            const double low = n * boxes[k].lo[axis], high = n * boxes[k].hi[axis];
            near[k] += n > 0 ? low : high;
            far[k] += n > 0 ? high : low;
        }
    }
    for (int k = 0; k < K; ++k) {
        to.lo[k] = profile(h.alpha_at(far[k]));
        to.hi[k] = profile(h.alpha_at(near[k]));
        to.constant[k] = to.hi[k] == 0 || to.lo[k] == 1;
        to.half_spaces[k] = !to.constant[k];
    }
}

// Combines the operators that make up nearly all of a tree: conjunctions, disjunctions, and products without negative
// operands. Returns false, with `to` unchanged, for any other.
template <int K>
bool combine_usual(NodeSizes<K>& to, Op op, const NodeSizes<K>& a, const NodeSizes<K>& b) {
    double absorbing = 0;
    if (op == Op::conjunction) {
        for (int k = 0; k < K; ++k) {
            to.lo[k] = std::max(0.0, a.lo[k] + b.lo[k] - 1);
            to.hi[k] = std::min(a.hi[k], b.hi[k]);
        }
    } else if (op == Op::disjunction) {
        absorbing = 1;
        for (int k = 0; k < K; ++k) {
            to.lo[k] = std::max(a.lo[k], b.lo[k]);
            to.hi[k] = std::min(1.0, a.hi[k] + b.hi[k]);
        }
    } else if (op == Op::product) {
        for (int k = 0; k < K; ++k)
            if (!(a.lo[k] >= 0 && b.lo[k] >= 0)) return false;
        for (int k = 0; k < K; ++k) {
            to.lo[k] = a.lo[k] * b.lo[k];
            to.hi[k] = a.hi[k] * b.hi[k];
        }
    } else {
        return false;
    }
    for (int k = 0; k < K; ++k) {
        const bool decided = to.lo[k] == absorbing && to.hi[k] == absorbing;
        to.constant[k] = (a.constant[k] && b.constant[k]) || ((a.constant[k] || b.constant[k]) && decided);
        to.half_spaces[k] = to.constant[k] ? 0 : a.half_spaces[k] + b.half_spaces[k];
    }
    return true;
}

template <int K>
void sizes_in(const DensityTree& tree, const Box* boxes, LocalSize* sizes) {
    thread_local std::vector<NodeSizes<K>> done;
    done.resize(tree.nodes.size());
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        const TreeNode& n = tree.nodes[i];
        NodeSizes<K>& to = done[i];
        if (n.op == Op::half_space) {
            set_half_space(to, tree.half_spaces[n.a], boxes);
            continue;
        }
        if (n.op == Op::constant) {
            for (int k = 0; k < K; ++k) to.set(k, {{n.value, n.value}, true}, 0);
            continue;
        }
        const NodeSizes<K>& a = done[n.a];
        if (n.b < 0) {
            for (int k = 0; k < K; ++k) {
                const Range r = combine(n.op, a.range(k), {});
                to.set(k, {r, is_constant(n.op, r, a.range(k), {})}, a.half_spaces[k]);
            }
        } else if (const NodeSizes<K>& b = done[n.b]; !combine_usual(to, n.op, a, b)) {
            for (int k = 0; k < K; ++k) {
                const Range r = combine(n.op, a.range(k), b.range(k));
                to.set(k, {r, is_constant(n.op, r, a.range(k), b.range(k))}, a.half_spaces[k] + b.half_spaces[k]);
            }
        }
        if (n.support < 0) continue;
        for (int k = 0; k < K; ++k)
            if (intersection(tree.supports[n.support], boxes[k]).empty()) to.set(k, {{0, 0}, true}, 0);
    }
    for (int k = 0; k < K; ++k) sizes[k] = {done.back().range(k), done.back().half_spaces[k]};
}

}  // namespace

Range distance_range(const HalfSpace& h, const Box& box) {
    if (h.round) {
        const Range u = h.round->range(box);
        return {u.lo - h.offset, u.hi - h.offset};
    }
    double lo = -h.offset, hi = -h.offset;
    for (int k = 0; k < 3; ++k) {
        const double n = h.normal[k];
        if (n == 0) continue;  // 0·∞ would be NaN
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

void local_sizes(const DensityTree& tree, std::span<const Box> boxes, LocalSize* sizes) {
    for (; boxes.size() >= 4; boxes = boxes.subspan(4), sizes += 4) sizes_in<4>(tree, boxes.data(), sizes);
    if (boxes.size() >= 2) {
        sizes_in<2>(tree, boxes.data(), sizes);
        boxes = boxes.subspan(2);
        sizes += 2;
    }
    if (!boxes.empty()) sizes_in<1>(tree, boxes.data(), sizes);
}

LocalSize local_size(const DensityTree& tree, const Box& box) {
    LocalSize size;
    sizes_in<1>(tree, &box, &size);
    return size;
}

bool bounds_hold(const DensityTree& tree, const Box& box) {
    const std::vector<NodeRange>& all = ranges(tree, box);
    const auto is_unit = [&](int i) {
        const TreeNode& n = tree.nodes[i];
        if (n.op != Op::constant && n.op != Op::sum && n.op != Op::difference) return true;
        return all[i].lo >= 0 && all[i].hi <= 1;
    };
    for (const TreeNode& n : tree.nodes) {
        if (n.op == Op::half_space || n.op == Op::constant) continue;
        if (!is_unit(n.a) || (n.b >= 0 && !is_unit(n.b))) return false;
    }
    return true;
}

Pruned prune_further(const DensityTree& tree, const std::vector<Range>& half_spaces, bool (&is_classified)(Range)) {
    const std::vector<NodeRange>& all = ranges(tree, half_spaces);
    if (is_classified(all.back())) return {{}, all.back()};
    // Copies of nearly all of a large tree, one for each of very many boxes, would take the memory of all of them.
    constexpr std::size_t large = 512;
    const std::size_t before = tree.half_spaces.size();
    Folding folding(tree, all);
    const std::size_t left = std::size_t(folding.size());
    if (left == before || (left > large && 4 * left > 3 * before)) return {{}, all.back()};
    return {folding.run(), all.back()};
}

Pruned prune(const DensityTree& tree, const Box& box) {
    const std::vector<NodeRange>& all = ranges(tree, box);
    return {Folding(tree, all).run(), all.back()};
}

Pruned prune(const DensityTree& tree, const std::vector<Range>& half_spaces) {
    const std::vector<NodeRange>& all = ranges(tree, half_spaces);
    return {Folding(tree, all).run(), all.back()};
}

}  // namespace deburr
