#include "bounds/decision_diagram.hpp"

#include <algorithm>
#include <map>
#include <tuple>

namespace deburr {
namespace {

// Normals and radii that differ by less come from the same plane through other arithmetic: two
// chains of transforms differ by a few ε; a millionth of a degree is 2·10⁻⁸.
constexpr double same_direction = 1e-9, same_radius = 1e-9;
// Thresholds: relative to the largest offset, as that is what their rounding is relative to.
constexpr double same_threshold = 1e-12;
constexpr std::size_t max_nodes = 100'000;

// Where a half-space stands in its family.
struct Literal {
    int family = -1, threshold = -1;
    bool above = false;  // normal against the family's: true where the coordinate is above τ
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
            Literal& literal = literals_[node.a];
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

    void combine(int root) {
        std::vector<int> done(reached_.size(), 0);
        for (std::size_t i = 0; i < reached_.size(); ++i) {
            if (!reached_[i]) continue;
            const TreeNode& n = tree_.nodes[i];
            const auto child = [&](int c) { return done[c]; };
            switch (n.op) {
                case Op::constant: done[i] = n.value > 0.5; break;
                case Op::half_space: done[i] = literal(literals_[n.a]); break;
                case Op::complement: done[i] = apply(Op::complement, child(n.a), 0); break;
                default: done[i] = apply(n.op, child(n.a), child(n.b)); break;
            }
        }
        diagram_.root = done[root];
    }

    int literal(const Literal& l) {
        return add({l.family, {l.threshold}, l.above ? std::vector{0, 1} : std::vector{1, 0}});
    }

    // Merges gaps that lead to the same node; a decision that decides nothing is its child.
    int add(Decision node) {
        Decision least{node.family, {}, {node.children[0]}};
        for (std::size_t j = 0; j < node.thresholds.size(); ++j) {
            if (node.children[j + 1] == least.children.back()) continue;
            least.thresholds.push_back(node.thresholds[j]);
            least.children.push_back(node.children[j + 1]);
        }
        if (least.thresholds.empty()) return least.children[0];
        const auto key = std::make_tuple(least.family, least.thresholds, least.children);
        const auto [entry, is_new] = unique_.try_emplace(key, int(diagram_.nodes.size()));
        if (is_new) {
            if (diagram_.nodes.size() >= max_nodes) throw TooEntangled();
            diagram_.nodes.push_back(std::move(least));
        }
        return entry->second;
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
        const auto key = std::make_tuple(int(op), a, b);
        if (const auto known = applied_.find(key); known != applied_.end()) return known->second;

        // Copies: add() may move the nodes.
        const Decision da = diagram_.nodes[a];
        const Decision db = b < 2 ? Decision{} : diagram_.nodes[b];
        Decision node;
        node.family = db.family < 0 ? da.family : std::min(da.family, db.family);
        const bool in_a = da.family == node.family, in_b = db.family == node.family;
        std::size_t i = 0, j = 0;  // gap of a, of b
        for (;;) {
            node.children.push_back(apply(op, in_a ? da.children[i] : a, in_b ? db.children[j] : b));
            const bool more_a = in_a && i < da.thresholds.size();
            const bool more_b = in_b && j < db.thresholds.size();
            if (!more_a && !more_b) break;
            const int next = !more_b   ? da.thresholds[i]
                             : !more_a ? db.thresholds[j]
                                       : std::min(da.thresholds[i], db.thresholds[j]);
            node.thresholds.push_back(next);
            if (more_a && da.thresholds[i] == next) ++i;
            if (more_b && db.thresholds[j] == next) ++j;
        }
        const int result = add(std::move(node));
        applied_[key] = result;
        return result;
    }

    const DensityTree& tree_;
    DecisionDiagram diagram_;
    std::vector<char> reached_;
    std::vector<Literal> literals_;
    std::map<std::tuple<int, std::vector<int>, std::vector<int>>, int> unique_;
    std::map<std::tuple<int, int, int>, int> applied_;
};

}  // namespace

DecisionDiagram build_diagram(const DensityTree& tree, int root) { return Construction(tree, root).take(); }

}  // namespace deburr
