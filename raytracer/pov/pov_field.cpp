// Bound of the slope: over a box every node has a range of ρ and of each component of ∇ρ. For a decision, with V = cₘ +
// Σⱼ Fⱼ (cⱼ − cⱼ₊₁) as in bounds/local_density.cpp,
//
//     ∇V = Σⱼ ∇Fⱼ (cⱼ − cⱼ₊₁) + Σⱼ pⱼ ∇cⱼ,
//
// where the second sum is a weighted average.
#include "raytracer/pov/pov_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <queue>

#include "bounds/decision_diagram.hpp"
#include "bounds/round_density.hpp"
#include "raytracer/pov/pov_round.hpp"
#include "raytracer/util/errors.hpp"

namespace deburr {

// [Lobb eq. 2], expanded. POV-Ray evaluates only the branch of a select that is chosen; with min and max csg_examples
// takes 2.3 times as long.
std::string pov_profile(bool by_cases) {
    const std::string text = "// Density of a half-space at the distance a, in radii, from its plane.\n";
    if (by_cases)
        return text + "#declare Rho = function(a) { select(a + 1, 1, select(1 - a, 0, 0.5 + a*(a*a - 3)*0.25)) }\n";
    return text +
           "#declare Cubic = function(a) { 0.5 + a*(a*a - 3)*0.25 }\n"
           "#declare Rho = function(a) { Cubic(min(max(a, -1), 1)) }\n";
}

namespace {

// Limit of work for the slope's bound, in nodes and half-spaces evaluated over a box (some tenths of a second), and the
// ratio of bound to slope that is close enough.
constexpr double max_work = 2e6;
constexpr double near_enough = 1.01;

Range plus(Range a, Range b) { return {a.lo + b.lo, a.hi + b.hi}; }
Range minus(Range a, Range b) { return {a.lo - b.hi, a.hi - b.lo}; }
Range hull_of(Range a, Range b) { return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)}; }
Range times(Range a, Range b) {
    const auto [lo, hi] = std::minmax({a.lo * b.lo, a.lo * b.hi, a.hi * b.lo, a.hi * b.hi});
    return {lo, hi};
}

// The range of a weighted average, from ranges of values and of weights whose sum is 1: the hull of the values with
// positive weight, intersected with the sum of the products.
class Average {
public:
    void add(Range weight, Range value) {
        if (weight.hi <= 0) return;
        hull_ = none_ ? value : hull_of(hull_, value);
        sum_ = plus(sum_, times(weight, value));
        none_ = false;
    }
    Range range() const { return {std::max(hull_.lo, sum_.lo), std::min(hull_.hi, sum_.hi)}; }

private:
    Range hull_, sum_;
    bool none_ = true;
};

// The range of dρ/dα for a range of α.
Range slope_range(Range alpha) {
    const double a = profile_slope(alpha.lo), b = profile_slope(alpha.hi);
    const double steepest = alpha.lo <= 0 && alpha.hi >= 0 ? profile_slope(0) : std::min(a, b);
    return {steepest, std::max(a, b)};
}

std::string rho_of(const HalfSpace& h) {
    if (h.round) return fmt::format("Rho(({}{:+})*{})", pov_coordinate(*h.round), -h.offset, 1 / h.radius);
    std::string text = "Rho(";
    const char* const names[3] = {"*x", "*y", "*z"};
    bool first = true;
    for (int k = 0; k < 3; ++k) {
        const double c = h.normal[k] / h.radius;
        if (c == 0) continue;
        text += fmt::format(fmt::runtime(first ? "{}{}" : "{:+}{}"), c, names[k]);
        first = false;
    }
    if (h.offset != 0) text += fmt::format("{:+}", -h.offset / h.radius);
    text += ')';
    return text;
}

}  // namespace

PovField::PovField(const DensityTree& tree, int line)
    : line_(line), half_spaces_(tree.half_spaces), rounds_(tree.rounds) {
    // The nodes above all Boolean operators; each Boolean part below them becomes one decision diagram.
    std::vector<char> arithmetic(tree.nodes.size(), false);
    arithmetic.back() = true;
    const auto is_arithmetic = [](Op op) { return op == Op::sum || op == Op::product || op == Op::difference; };
    for (int i = tree.root(); i >= 0; --i) {
        const TreeNode& n = tree.nodes[i];
        if (!arithmetic[i] || !is_arithmetic(n.op)) continue;
        arithmetic[n.a] = arithmetic[n.b] = true;
    }
    std::vector<int> new_index(tree.nodes.size(), -1);
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        if (!arithmetic[i]) continue;
        const TreeNode& n = tree.nodes[i];
        const Step step = n.op == Op::sum ? Step::sum : n.op == Op::product ? Step::product : Step::difference;
        if (n.op == Op::constant)
            new_index[i] = add({Step::constant, n.value, -1, -1, {}, {}});
        else if (n.op == Op::half_space)
            new_index[i] = add({Step::half_space, 0, n.a, -1, {}, {}});
        else if (is_arithmetic(n.op))
            new_index[i] = add({step, 0, new_index[n.a], new_index[n.b], {}, {}});
        else
            new_index[i] = add_boolean(tree, int(i));
    }
}

int PovField::add(Node node) {
    nodes_.push_back(std::move(node));
    return int(nodes_.size()) - 1;
}

int PovField::add_boolean(const DensityTree& tree, int root) {
    DecisionDiagram diagram;
    try {
        diagram = build_diagram(tree, root);
    } catch (const TooEntangled&) {
        throw TooEntangled(line_);
    }
    std::vector<int> first_plane;  // of each family
    for (const PlaneFamily& family : diagram.families) {
        first_plane.push_back(int(half_spaces_.size()));
        for (const double t : family.thresholds)
            half_spaces_.push_back({family.normal, t, family.radius, family.round});
    }
    std::vector<char> reached(diagram.nodes.size(), false);
    reached[diagram.root] = true;
    for (int i = diagram.root; i >= 2; --i)
        if (reached[i])
            for (const int child : diagram.nodes[i].children) reached[child] = true;
    std::vector<int> new_index(diagram.nodes.size(), -1);
    for (int i = 0; i <= diagram.root; ++i) {
        if (!reached[i]) continue;
        const Decision& d = diagram.nodes[i];
        Node node{i < 2 ? Step::constant : Step::decision, double(i == 1), -1, -1, {}, {}};
        for (const int t : d.thresholds) node.planes.push_back(first_plane[d.family] + t);
        for (const int c : d.children) node.children.push_back(new_index[c]);
        new_index[i] = add(std::move(node));
    }
    return new_index[diagram.root];
}

// The text of Σ pⱼ cⱼ, where pⱼ = Fⱼ − Fⱼ₋₁, F₋₁ = 0 and Fₘ = 1.
std::string PovField::decision(const Node& node, const std::vector<std::string>& done) const {
    std::string text;
    const std::size_t m = node.planes.size();
    const auto rho = [&](std::size_t j) { return rho_of(half_spaces_[node.planes[j]]); };
    for (std::size_t j = 0; j <= m; ++j) {
        const Node& child = nodes_[node.children[j]];
        if (child.step == Step::constant && child.value == 0) continue;
        const std::string above = j < m ? rho(j) : "1";
        std::string term = j == 0 ? above : fmt::format("({}-{})", above, rho(j - 1));
        if (child.step != Step::constant) term += "*" + done[node.children[j]];
        text += (text.empty() ? "" : "+") + term;
    }
    return fmt::format("({})", text);
}

std::string PovField::formula() const {
    std::vector<double> terms;
    for (const Node& n : nodes_) {
        const auto at = [&](int i) { return terms[i]; };
        double count = n.step == Step::half_space ? 1 : 2 * double(n.planes.size());
        if (n.b >= 0) count += at(n.a) + at(n.b);
        for (const int c : n.children) count += at(c);
        terms.push_back(count);
    }
    if (terms.back() > max_terms)
        throw UnsupportedError(fmt::format("{}expected a formula of at most {:.0f} half-spaces for POV-Ray, got {:.3g}",
                                           line_ > 0 ? fmt::format("the solid of line {}: ", line_) : "", max_terms,
                                           terms.back()));

    std::vector<std::string> done;
    for (const Node& n : nodes_) {
        // An operand of an arithmetic node is used by that node only.
        const auto take = [&](int i) { return std::move(done[i]); };
        switch (n.step) {
            case Step::constant: done.push_back(fmt::format("{}", n.value)); break;
            case Step::half_space: done.push_back(rho_of(half_spaces_[n.a])); break;
            case Step::sum: done.push_back(fmt::format("({}+{})", take(n.a), take(n.b))); break;
            case Step::product: done.push_back(fmt::format("{}*{}", take(n.a), take(n.b))); break;
            case Step::difference: done.push_back(fmt::format("({}-{})", take(n.a), take(n.b))); break;
            case Step::decision: done.push_back(decision(n, done)); break;
        }
    }
    return done.back();
}

// Ranges of ρ and of the components of ∇ρ over a box.
struct PovField::Slopes {
    Range value;
    std::array<Range, 3> slope{};

    /// The greatest magnitude of each component of ∇ρ.
    Vec3 greatest() const {
        Vec3 most(0.0);
        for (int k = 0; k < 3; ++k) most[k] = std::max(-slope[k].lo, slope[k].hi);
        return most;
    }
};

PovField::Slopes PovField::slopes(const Box& box) const {
    std::vector<Slopes> planes, done;
    for (const HalfSpace& h : half_spaces_) {
        const Range distance = distance_range(h, box);
        const Range along = slope_range({distance.lo / h.radius, distance.hi / h.radius});
        Slopes s{density_range(h, box), {}};
        for (int k = 0; k < 3; ++k) {
            Vec3 axis(0.0);
            axis[k] = 1;
            const Range cosine = cosine_range(h, box, axis);
            s.slope[k] = times(along, {cosine.lo / h.radius, cosine.hi / h.radius});
        }
        planes.push_back(s);
    }
    for (const Node& n : nodes_) {
        Slopes s;
        const auto at = [&](int i) -> const Slopes& { return done[i]; };
        const auto each = [&](auto slope) {
            for (std::size_t k = 0; k < 3; ++k) s.slope[k] = slope(at(n.a).slope[k], at(n.b).slope[k]);
        };
        switch (n.step) {
            case Step::constant: s.value = {n.value, n.value}; break;
            case Step::half_space: s = planes[n.a]; break;
            case Step::sum:
                s.value = plus(at(n.a).value, at(n.b).value);
                each(plus);
                break;
            case Step::difference:
                s.value = minus(at(n.a).value, at(n.b).value);
                each(minus);
                break;
            case Step::product:
                s.value = times(at(n.a).value, at(n.b).value);
                each([&](Range a, Range b) { return plus(times(a, at(n.b).value), times(b, at(n.a).value)); });
                break;
            case Step::decision: {
                Average value;
                std::array<Average, 3> slope;
                for (std::size_t j = 0; j < n.children.size(); ++j) {
                    const Range before = j > 0 ? planes[n.planes[j - 1]].value : Range{0, 0};
                    const Range here = j < n.planes.size() ? planes[n.planes[j]].value : Range{1, 1};
                    const Range p{std::max(0.0, here.lo - before.hi), here.hi - before.lo};
                    const Slopes& child = at(n.children[j]);
                    value.add(p, child.value);
                    for (std::size_t k = 0; k < 3; ++k) slope[k].add(p, child.slope[k]);
                }
                s.value = value.range();
                for (std::size_t k = 0; k < 3; ++k) s.slope[k] = slope[k].range();
                for (std::size_t j = 0; j < n.planes.size(); ++j) {
                    const Range step = minus(at(n.children[j]).value, at(n.children[j + 1]).value);
                    for (std::size_t k = 0; k < 3; ++k)
                        s.slope[k] = plus(s.slope[k], times(planes[n.planes[j]].slope[k], step));
                }
            }
        }
        done.push_back(s);
    }
    return done.back();
}

double PovField::greatest_slope(const Box& box) const {
    struct Open {
        double most;
        Box box;
        int axis;  // along which ρ may vary most; the box is halved across it
        bool operator<(const Open& o) const { return most < o.most; }
    };
    std::priority_queue<Open> open;
    double met = 0;
    const auto examine = [&](const Box& b) {
        const Vec3 middle = 0.5 * (b.lo + b.hi);
        met = std::max(met, glm::length(slopes({middle, middle}).greatest()));
        const Vec3 most = slopes(b).greatest(), change = most * (b.hi - b.lo);
        const int axis = greatest_axis(change);
        open.push({glm::length(most), b, axis});
    };
    examine(box);
    const double work = 2 * double(nodes_.size() + half_spaces_.size());  // for a box and its middle
    for (double done = work; done < max_work && open.top().most > near_enough * met; done += 2 * work) {
        const Open widest = open.top();
        open.pop();
        Box half = widest.box, other = half;
        half.hi[widest.axis] = other.lo[widest.axis] = 0.5 * (half.lo[widest.axis] + half.hi[widest.axis]);
        examine(half);
        examine(other);
    }
    return open.top().most;
}

}  // namespace deburr
