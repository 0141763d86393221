// The density ρ is a whole number at every point, so with T(a, k) = {a ≥ k}
//
//     T(a + b, k) = ⋃ⱼ T(a, j) ∩ T(b, k − j)
//     T(a − b, k) = ⋃ⱼ T(a, j) \ T(b, j − k + 1)
//     T(a · b, k) = ⋃ T(a, i) ∩ T(b, j) over i, j > 0 with i·j ≥ k, united with the same for −a and −b   (k > 0)
//     T(a · b, k) = complement of T(−a · b, 1 − k)                                                   (k ≤ 0)
//
// where j runs over the values that a can have. T(a, k) is everything if k is at most a's least value, and nothing if
// it is greater than a's greatest value.
#include "polygonizer/mesh/sharp_set.hpp"

#include <algorithm>
#include <map>
#include <tuple>

namespace deburr {
namespace {

constexpr std::size_t max_nodes = 20'000;
constexpr int nothing = -1, everything = -2, too_many = -3;  // codes in place of a node

/// Converts a density into the set T(ρ, 1).
class Conversion {
public:
    explicit Conversion(const DensityTree& from) : from_(from) {
        to_.half_spaces = from.half_spaces;
        for (const TreeNode& n : from.nodes) {
            const auto at = [&](int child) { return range_[child]; };
            Whole r{0, 1};
            switch (n.op) {
                case Op::constant: r = {int(n.value > 0.5), int(n.value > 0.5)}; break;
                case Op::sum: r = {at(n.a).lo + at(n.b).lo, at(n.a).hi + at(n.b).hi}; break;
                case Op::difference: r = {at(n.a).lo - at(n.b).hi, at(n.a).hi - at(n.b).lo}; break;
                case Op::product: {
                    const Whole a = at(n.a), b = at(n.b);
                    const auto [lo, hi] = std::minmax({a.lo * b.lo, a.lo * b.hi, a.hi * b.lo, a.hi * b.hi});
                    r = {lo, hi};
                    break;
                }
                case Op::complement: r = {1 - at(n.a).hi, 1 - at(n.a).lo}; break;
                default: break;
            }
            range_.push_back(r);
        }
    }

    /// The set; without nodes if it would take too many.
    DensityTree run() {
        int root = least(from_.root(), 1, false);
        if (to_.nodes.size() > max_nodes) return {};
        if (root < 0 || root != to_.root()) {
            // The root must be the last node.
            if (root < 0)
                to_.nodes.push_back({Op::constant, -1, -1, root == everything ? 1.0 : 0.0});
            else
                to_.nodes.push_back(TreeNode(to_.nodes[root]));
        }
        return std::move(to_);
    }

private:
    struct Whole {
        int lo, hi;
    };

    Whole range(int node, bool negated) const {
        const Whole r = range_[node];
        return negated ? Whole{-r.hi, -r.lo} : r;
    }

    // T(±node, k) as a node, or a code.
    int least(int node, int k, bool negated) {
        const Whole r = range(node, negated);
        if (k <= r.lo) return everything;
        if (k > r.hi) return nothing;
        if (negated) return complement(least(node, 1 - k, false));
        const auto known = known_.find({node, k});
        if (known != known_.end()) return known->second;
        const int made = make(node, k);
        return known_[{node, k}] = made;
    }

    int make(int node, int k) {
        const TreeNode& n = from_.nodes[node];
        if (to_.nodes.size() > max_nodes) return too_many;
        const int before = node_;
        node_ = node;
        int set = nothing;
        switch (n.op) {
            case Op::half_space: set = add({Op::half_space, n.a, -1, 0, n.line}); break;
            case Op::complement: set = complement(least(n.a, 2 - k, false)); break;
            case Op::conjunction: set = intersect(least(n.a, 1, false), least(n.b, 1, false)); break;
            case Op::disjunction: set = unite(least(n.a, 1, false), least(n.b, 1, false)); break;
            case Op::sum:
            case Op::difference: {
                const bool minus = n.op == Op::difference;
                const Whole a = range(n.a, false), b = range(n.b, minus);
                // With a greater than `first` b could be anything, and with a less than `last` b could be nothing.
                const int first = std::clamp(k - b.lo, a.lo, a.hi), last = std::clamp(k - b.hi, a.lo, a.hi);
                for (int j = first; j >= last; --j)
                    set = unite(set, intersect(least(n.a, j, false), least(n.b, k - j, minus)));
                break;
            }
            case Op::product:
                if (k > 0)
                    set = unite(product(n, k, false), product(n, k, true));
                else
                    set = complement(negative_product(n, 1 - k));
                break;
            default: break;
        }
        node_ = before;
        return set;
    }

    // The set where ±a and ±b are positive and their product is at least k.
    int product(const TreeNode& n, int k, bool negated) {
        int set = nothing;
        for (int i = 1; i <= range(n.a, negated).hi; ++i)
            set = unite(set, intersect(least(n.a, i, negated), least(n.b, (k + i - 1) / i, negated)));
        return set;
    }
    // The set where the product is at most −k.
    int negative_product(const TreeNode& n, int k) {
        int set = nothing;
        for (const bool negated : {false, true})
            for (int i = 1; i <= range(n.a, negated).hi; ++i)
                set = unite(set, intersect(least(n.a, i, negated), least(n.b, (k + i - 1) / i, !negated)));
        return set;
    }

    int intersect(int a, int b) {
        if (a == too_many || b == too_many) return too_many;
        if (a == nothing || b == nothing) return nothing;
        if (a == everything || a == b) return b;
        if (b == everything) return a;
        return add({Op::conjunction, a, b});
    }
    int unite(int a, int b) {
        if (a == too_many || b == too_many) return too_many;
        if (a == everything || b == everything) return everything;
        if (a == nothing || a == b) return b;
        if (b == nothing) return a;
        return add({Op::disjunction, a, b});
    }
    int complement(int a) {
        if (a == too_many) return too_many;
        if (a == nothing) return everything;
        if (a == everything) return nothing;
        if (to_.nodes[a].op == Op::complement) return to_.nodes[a].a;
        return add({Op::complement, a, -1});
    }
    int add(TreeNode node) {
        const auto key = std::make_tuple(int(node.op), node.a, node.b);
        const auto [at, fresh] = made_.try_emplace(key, int(to_.nodes.size()));
        node.line = from_.nodes[node_].line;
        if (fresh) to_.nodes.push_back(node);
        return at->second;
    }

    const DensityTree& from_;
    DensityTree to_;
    std::vector<Whole> range_;  // of ρ, by node
    std::map<std::pair<int, int>, int> known_;
    std::map<std::tuple<int, int, int>, int> made_;
    int node_ = 0;  // the node that is being converted
};

}  // namespace

DensityTree sharp_set(DensityTree density) {
    const bool boolean = std::all_of(density.nodes.begin(), density.nodes.end(), [](const TreeNode& n) {
        return n.op != Op::sum && n.op != Op::product && n.op != Op::difference;
    });
    if (boolean) return density;
    DensityTree set = Conversion(density).run();
    return set.nodes.empty() ? density : set;
}

}  // namespace deburr
