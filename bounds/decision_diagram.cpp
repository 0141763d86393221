#include "bounds/decision_diagram.hpp"

#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <unordered_set>

namespace deburr {
namespace {

// Normals (unit vectors) and radii (relatively) that differ by less count as the same: two chains of transforms that
// lead to one plane differ by a few ε; a millionth of a degree is 2·10⁻⁸.
constexpr double same_direction = 1e-9, same_radius = 1e-9;
// Thresholds that differ by less count as the same, relative to the largest offset, as their rounding is.
constexpr double same_threshold = 1e-12;
constexpr std::size_t max_nodes = 100'000;

// The place of a half-space in its family.
struct FamilyLiteral {
    int family = -1, threshold = -1;
    bool above = false;  // normal opposite to the family's: the half-space is true where the coordinate > τ
};

class Construction {
public:
    Construction(const DensityTree& tree, int root) : tree_(tree) {
        diagram_.nodes.resize(2);
        reach(root);
        find_families();
        combine(root);
    }
    DecisionDiagram take() { return std::move(diagram_); }

private:
    void reach(int root) {
        reached_.assign(std::size_t(root) + 1, false);
        reached_[root] = true;
        for (int i = root; i >= 0; --i) {
            const TreeNode& n = tree_.nodes[i];
            if (!reached_[i] || n.op == Op::half_space || n.op == Op::constant) continue;
            reached_[n.a] = true;
            if (n.b >= 0) reached_[n.b] = true;
        }
    }

    void find_families() {
        literals_.resize(tree_.half_spaces.size());
        std::vector<std::vector<std::pair<double, int>>> offsets;  // (τ, half-space) by family
        double scale = 0;
        for (std::size_t i = 0; i < reached_.size(); ++i) {
            const TreeNode& node = tree_.nodes[i];
            if (!reached_[i] || node.op != Op::half_space) continue;
            const HalfSpace& h = tree_.half_spaces[node.a];
            FamilyLiteral& literal = literals_[node.a];
            literal.family = family_of(h);
            if (std::size_t(literal.family) == offsets.size()) offsets.emplace_back();
            const Vec3 n = diagram_.families[literal.family].normal;
            literal.above = !h.round && glm::dot(n, h.normal) < 0;
            offsets[literal.family].push_back({literal.above ? -h.offset : h.offset, node.a});
            scale = std::max(scale, std::abs(h.offset));
        }
        for (std::size_t f = 0; f < offsets.size(); ++f) {
            std::sort(offsets[f].begin(), offsets[f].end());
            std::vector<double>& thresholds = diagram_.families[f].thresholds;
            for (const auto& [tau, half_space] : offsets[f]) {
                if (thresholds.empty() || tau - thresholds.back() > same_threshold * scale) thresholds.push_back(tau);
                literals_[half_space].threshold = int(thresholds.size()) - 1;
            }
        }
    }

    int family_of(const HalfSpace& h) {
        for (std::size_t f = 0; f < diagram_.families.size(); ++f) {
            const PlaneFamily& family = diagram_.families[f];
            if (h.round || family.round) {
                if (h.round && family.round && std::abs(h.radius - family.radius) <= same_radius * family.radius &&
                    h.round->is_same(*family.round))
                    return int(f);
                continue;
            }
            const Vec3 n = glm::dot(h.normal, family.normal) < 0 ? -h.normal : h.normal;
            if (std::abs(h.radius - family.radius) <= same_radius * family.radius &&
                glm::length(n - family.normal) <= same_direction)
                return int(f);
        }
        diagram_.families.push_back({h.normal, h.radius, {}, h.round});
        return int(diagram_.families.size()) - 1;
    }

    // The nodes that are operands of exactly one node, whose operator is their own: links of a chain.
    std::vector<char> merged_nodes() const {
        std::vector<int> uses(reached_.size(), 0);
        std::vector<char> merged(reached_.size(), false);
        for (std::size_t i = 0; i < reached_.size(); ++i) {
            const TreeNode& n = tree_.nodes[i];
            if (!reached_[i] || n.op == Op::half_space || n.op == Op::constant) continue;
            for (const int child : {n.a, n.b}) {
                if (child < 0) continue;
                ++uses[child];
                merged[child] = n.op != Op::complement && tree_.nodes[child].op == n.op;
            }
        }
        for (std::size_t i = 0; i < merged.size(); ++i) merged[i] = merged[i] && uses[i] == 1;
        return merged;
    }

    // Builds the diagrams of all reached nodes. A chain a & b & c … is combined from its end: families are numbered as
    // they occur, so each operand goes on top of the diagram so far instead of below all of it, which would take time
    // quadratic in the chain's length.
    void combine(int root) {
        std::vector<int> done(reached_.size(), 0), open, operands;
        const std::vector<char> merged = merged_nodes();
        for (std::size_t i = 0; i < reached_.size(); ++i) {
            if (!reached_[i] || merged[i]) continue;
            const TreeNode& n = tree_.nodes[i];
            switch (n.op) {
                case Op::constant: done[i] = n.value > 0.5; continue;
                case Op::half_space: done[i] = literal(literals_[n.a]); continue;
                case Op::complement: done[i] = apply(Op::complement, done[n.a], 0); continue;
                default: break;
            }
            operands.clear();
            open = {n.b, n.a};
            while (!open.empty()) {
                const int operand = open.back();
                open.pop_back();
                if (merged[operand])
                    open.insert(open.end(), {tree_.nodes[operand].b, tree_.nodes[operand].a});
                else
                    operands.push_back(operand);
            }
            done[i] = done[operands.back()];
            for (std::size_t k = operands.size() - 1; k-- > 0;) done[i] = apply(n.op, done[operands[k]], done[i]);
        }
        diagram_.root = done[root];
    }

    int literal(const FamilyLiteral& l) {
        return add({l.family, {l.threshold}, l.above ? std::vector{0, 1} : std::vector{1, 0}});
    }

    // The node's number, or that of an equal one. Gaps that lead to the same child are merged, and a decision with one
    // child left is that child.
    int add(Decision node) {
        std::size_t kept = 0;  // thresholds
        for (std::size_t j = 0; j < node.thresholds.size(); ++j) {
            if (node.children[j + 1] == node.children[kept]) continue;
            node.thresholds[kept++] = node.thresholds[j];
            node.children[kept] = node.children[j + 1];
        }
        if (kept == 0) return node.children[0];
        node.thresholds.resize(kept);
        node.children.resize(kept + 1);
        // The set holds node numbers and hashes the nodes themselves, so the new node is appended first.
        diagram_.nodes.push_back(std::move(node));
        const auto [entry, is_new] = unique_.insert(int(diagram_.nodes.size()) - 1);
        if (!is_new)
            diagram_.nodes.pop_back();
        else if (diagram_.nodes.size() > max_nodes)
            throw TooEntangled();
        return *entry;
    }

    int apply(Op op, int a, int b) {
        if (op == Op::complement) {
            if (a < 2) return 1 - a;
        } else {
            const int absorbing = op == Op::conjunction ? 0 : 1;
            if (a == b) return a;
            if (a == absorbing || b == absorbing) return absorbing;
            if (a < 2) return b;
            if (b < 2) return a;
            if (a > b) std::swap(a, b);
        }
        static_assert(max_nodes < 1u << 30);
        const std::uint64_t key = std::uint64_t(op) << 60 | std::uint64_t(a) << 30 | std::uint64_t(b);
        if (const auto known = applied_.find(key); known != applied_.end()) return known->second;

        // Nodes are looked up by number each time, because add() may move them. Constants have no family.
        const auto at = [&](int i) -> const Decision& { return diagram_.nodes[i]; };
        Decision node;
        node.family = at(b).family < 0 ? at(a).family : std::min(at(a).family, at(b).family);
        const bool in_a = at(a).family == node.family, in_b = at(b).family == node.family;
        std::size_t i = 0, j = 0;  // gaps of a and of b
        for (;;) {
            node.children.push_back(apply(op, in_a ? at(a).children[i] : a, in_b ? at(b).children[j] : b));
            const bool more_a = in_a && i < at(a).thresholds.size();
            const bool more_b = in_b && j < at(b).thresholds.size();
            if (!more_a && !more_b) break;
            const int next = !more_b   ? at(a).thresholds[i]
                             : !more_a ? at(b).thresholds[j]
                                       : std::min(at(a).thresholds[i], at(b).thresholds[j]);
            node.thresholds.push_back(next);
            if (more_a && at(a).thresholds[i] == next) ++i;
            if (more_b && at(b).thresholds[j] == next) ++j;
        }
        const int result = add(std::move(node));
        applied_[key] = result;
        return result;
    }

    struct Hash {
        const std::vector<Decision>& nodes;
        std::size_t operator()(int i) const {
            std::uint64_t h = std::uint64_t(nodes[i].family);
            const auto mix = [&](int value) { h = (h ^ std::uint64_t(value)) * 0x9e3779b97f4a7c15u, h ^= h >> 29; };
            for (const int threshold : nodes[i].thresholds) mix(threshold);
            for (const int child : nodes[i].children) mix(child);
            return h;
        }
    };
    struct Same {
        const std::vector<Decision>& nodes;
        bool operator()(int a, int b) const { return nodes[a] == nodes[b]; }
    };

    const DensityTree& tree_;
    DecisionDiagram diagram_;
    std::vector<char> reached_;
    std::vector<FamilyLiteral> literals_;
    std::unordered_set<int, Hash, Same> unique_{16, Hash{diagram_.nodes}, Same{diagram_.nodes}};
    std::unordered_map<std::uint64_t, int> applied_;
};

std::string too_entangled(int line) {
    std::string text;
    if (line > 0) text.append("the solid of line ").append(std::to_string(line)).append(": ");
    return text +=
           "expected a Boolean density whose decision diagram has at most 100,000 nodes, got more; too many of its "
           "planes meet within one radius";
}

}  // namespace

TooEntangled::TooEntangled(int line) : std::length_error(too_entangled(line)) {}

DecisionDiagram build_diagram(const DensityTree& tree, int root) { return Construction(tree, root).take(); }

}  // namespace deburr
