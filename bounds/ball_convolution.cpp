#include "bounds/ball_convolution.hpp"

#include <algorithm>
#include <cassert>

#include "bounds/ball_arrangement.hpp"

namespace deburr {
namespace {

// In densities of at most this many half-spaces, as those of cells are, half-spaces are compared for equal ones.
constexpr std::size_t max_compared = 64;
// Tolerances within which planes count as one that the scene has placed in two ways.
constexpr double equal_normals = 1e-13, equal_offsets = 1e-13;

/// How a half-space or node occurs in the function.
enum Use : char { as_it_is = 1, complemented = 2, both_ways = 3 };

constexpr char unknown = 2;

// Upper bound of the error of at().
constexpr double error = 2e-8;

}  // namespace

BallConvolution::BallConvolution(const DensityTree& tree) {
    assert(tree.nodes.back().op == Op::convolution);
    to_ball_ = glm::inverse(tree.ball);
    find_equal(tree);
    if (half_spaces_.size() <= std::size_t(max_tabulated)) drop_idle();
    steps_ = short_circuit(function_);

    // From the root down: whether a node is used as it is, complemented, or both ways.
    const auto& nodes = function_.nodes;
    std::vector<char> use(nodes.size(), 0);
    uses_.assign(half_spaces_.size(), 0);
    use.back() = as_it_is;
    for (std::size_t i = nodes.size(); i-- > 0;) {
        const auto& n = nodes[i];
        const auto turned = [](char u) {
            return char(u == as_it_is ? complemented : u == complemented ? as_it_is : both_ways);
        };
        if (n.op == Op::constant) continue;
        if (n.op == Op::half_space) {
            uses_[n.a] |= n.negated ? turned(use[i]) : use[i];
            continue;
        }
        for (const int child : {n.a, n.b})
            if (child >= 0) use[child] |= n.op == Op::complement ? turned(use[i]) : use[i];
    }
}

/// Sets function_, half_spaces_ and normals_, with one half-space for those that lie on one plane.
void BallConvolution::find_equal(const DensityTree& tree) {
    const Mat3 carry = glm::transpose(tree.ball);
    const bool compare = tree.half_spaces.size() <= max_compared;
    for (std::size_t i = 0; i + 1 < tree.nodes.size(); ++i) {
        const TreeNode& n = tree.nodes[i];
        if (n.op == Op::constant) {
            function_.nodes.push_back({n.op, n.value > 0.5});
            continue;
        }
        if (n.op != Op::half_space) {
            function_.nodes.push_back({n.op, n.a, n.b});
            continue;
        }
        const HalfSpace& h = tree.half_spaces[n.a];
        const Vec3 normal = glm::normalize(carry * h.normal);
        BooleanFunction::Node node{Op::half_space};
        if (compare)
            for (std::size_t j = 0; j < half_spaces_.size() && node.a < 0; ++j)
                for (const double sign : {1.0, -1.0})
                    if (glm::length(sign * normal - normals_[j]) <= equal_normals &&
                        std::abs(sign * h.offset - half_spaces_[j].offset) <=
                            equal_offsets * (std::abs(h.offset) + h.radius)) {
                        node.a = int(j);
                        node.negated = sign < 0;
                        break;
                    }
        if (node.a < 0) {
            node.a = int(half_spaces_.size());
            half_spaces_.push_back(h);
            normals_.push_back(normal);
        }
        function_.nodes.push_back(node);
    }
}

// Drops half-spaces on which the function does not depend, as where one box's face is inside of another box.
void BallConvolution::drop_idle() {
    std::vector<Literal> literals;
    for (std::size_t i = 0; i < half_spaces_.size(); ++i) literals.push_back({int(i), true});
    BooleanSteps steps;
    restrict_to(short_circuit(function_), literals, steps);
    const std::vector<char> relevant = relevant_variables(steps, int(literals.size()));
    std::vector<int> new_index;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < literals.size(); ++i) {
        if (!relevant[i]) {
            new_index.push_back(-1);
            continue;
        }
        half_spaces_[kept] = half_spaces_[i];
        normals_[kept] = normals_[i];
        new_index.push_back(int(kept++));
    }
    half_spaces_.resize(kept);
    normals_.resize(kept);
    for (BooleanFunction::Node& n : function_.nodes) {
        if (n.op != Op::half_space) continue;
        n.a = new_index[n.a];
        if (n.a < 0) n = {Op::constant, n.negated};
    }
}

// Drops planes on which the function does not depend, as where two flush faces leave no trace.
static void drop_irrelevant(std::vector<BallPlane>& planes, std::vector<std::size_t>& whose, BooleanSteps& steps) {
    const std::vector<char> relevant = relevant_variables(steps, int(planes.size()));
    if (std::find(relevant.begin(), relevant.end(), false) == relevant.end()) return;
    thread_local std::vector<Literal> literals;
    literals.assign(planes.size(), {});
    std::size_t kept = 0;
    for (std::size_t p = 0; p < planes.size(); ++p) {
        if (!relevant[p]) continue;
        planes[kept] = planes[p];
        whose[kept] = whose[p];
        literals[p] = {int(kept++), true};
    }
    planes.resize(kept);
    whose.resize(kept);
    BooleanSteps left;
    restrict_to(steps, literals, left);
    steps = std::move(left);
}

// The steps that are left where `known` half-spaces are 0 or 1; their variables are still the half-spaces.
void BallConvolution::find_open(const std::vector<char>& known, BooleanSteps& left) const {
    thread_local std::vector<Literal> literals;
    literals.clear();
    for (std::size_t i = 0; i < known.size(); ++i)
        literals.push_back(known[i] == unknown ? Literal{int(i), true} : Literal{-1, known[i] != 0});
    restrict_to(steps_, literals, left);
}

double BallConvolution::at(const std::vector<double>& alpha, std::vector<double>& slope) const {
    thread_local std::vector<char> known;
    thread_local std::vector<Literal> literals;  // of every half-space: which plane it is
    thread_local std::vector<BallPlane> planes;
    thread_local std::vector<std::size_t> whose;
    thread_local std::vector<double> areas;
    thread_local BooleanSteps steps;
    thread_local BallArrangement arrangement;

    const std::size_t count = half_spaces_.size();
    slope.assign(count, 0);
    known.resize(count);
    for (std::size_t i = 0; i < count; ++i) known[i] = alpha[i] >= 1 ? 0 : alpha[i] <= -1 ? 1 : unknown;
    find_open(known, steps);
    planes.clear();
    whose.clear();
    literals.assign(count, {});
    const auto add_plane = [&](std::size_t i) {
        Literal& l = literals[i];
        for (std::size_t p = 0; p < planes.size() && l.variable < 0; ++p)
            for (const double sign : {1.0, -1.0}) {
                if (std::abs(sign * -alpha[i] - planes[p].t) > one_plane) continue;
                if (glm::length(sign * normals_[i] - planes[p].normal) > one_plane) continue;
                l = {int(p), sign > 0};
                break;
            }
        if (l.variable >= 0) return;
        l = {int(planes.size()), true};
        planes.push_back({normals_[i], -alpha[i]});
        whose.push_back(i);
    };
    for (BooleanStep& s : steps.steps) {
        if (literals[s.variable].variable < 0) add_plane(std::size_t(s.variable));
        const Literal l = literals[s.variable];
        s.variable = l.variable;
        if (!l.same) std::swap(s.if_true, s.if_false);
    }
    if (planes.size() <= std::size_t(max_tabulated)) drop_irrelevant(planes, whose, steps);
    if (planes.empty()) return steps.first == ends_true;
    if (planes.size() == 1) {  // the cubic of a half-space or of its complement
        const double side = steps.value([](int) { return false; }) ? -1 : 1, a = side * -planes[0].t;
        slope[whose[0]] = side * profile_slope(a);
        return profile(a);
    }
    const double share = arrangement.measure(planes, steps, areas);
    for (std::size_t p = 0; p < planes.size(); ++p) slope[whose[p]] = -3 / (4 * pi) * areas[p];
    return share;
}

Range BallConvolution::range(const std::vector<Range>& half_spaces) const {
    thread_local std::vector<Range> done;
    done.clear();
    for (const BooleanFunction::Node& n : function_.nodes) {
        const auto at = [&](int child) { return child < 0 ? Range{} : done[child]; };
        if (n.op == Op::constant) {
            done.push_back({double(n.a), double(n.a)});
        } else if (n.op == Op::half_space) {
            const Range rho = half_spaces[n.a];
            done.push_back(n.negated ? combine(Op::complement, rho, {}) : rho);
        } else {
            done.push_back(combine(n.op, at(n.a), at(n.b)));
        }
    }
    return done.back();
}

Range BallConvolution::range(const Box& box) const {
    thread_local std::vector<Range> leaves;
    thread_local std::vector<double> alpha, slope;
    leaves.clear();
    for (const HalfSpace& h : half_spaces_) leaves.push_back(density_range(h, box));
    Range all = range(leaves);
    if (!box.finite() || half_spaces_.size() < 2 || all.lo == all.hi) return all;
    // ρ changes by at most ¾ per radius of the ball.
    const Vec3 center = 0.5 * (box.lo + box.hi), half = 0.5 * (box.hi - box.lo);
    double farthest = 0;
    for (const double y : {-half.y, half.y})
        for (const double z : {-half.z, half.z}) farthest = std::max(farthest, glm::length(in_ball({half.x, y, z})));
    alpha.clear();
    for (const HalfSpace& h : half_spaces_) alpha.push_back(h.alpha(center));
    const double reach = 0.75 * farthest * (1 + 8 * epsilon) + error, middle = at(alpha, slope);
    return {std::max(all.lo, middle - reach), std::min(all.hi, middle + reach)};
}

// Derivation of bounds(): as the ball's centre moves by v, plane p's disc, on which wₚ is fixed to the plane, moves
// along the plane by v∥, and its radius ρ grows by −αα′/ρ. So
//
//     Aₚ′ = ∮ wₚ (v∥·ν − αα′/ρ) ds    around the disc, ν its outward direction,    |ρ″| ≤ ¾/π Σ |α′ₚ| |Aₚ′|.
//
// If wₚ is nowhere negative, |Aₚ′| is greatest where wₚ is 1 on the arc on which the bracket has one sign: 2ρ|v∥|(√(1 −
// κ²) + κ arccos(−κ)) for κ = |αα′|/(ρ|v∥|) ≤ 1, which is convex in κ and so at most 2ρ|v∥| + 2(π − 1)|αα′|; and
// 2π|αα′| for κ ≥ 1. If wₚ has both signs, the integrals over the two arcs are added; they differ by 2π|αα′|.
//
// L is the lesser of two bounds: the slope is an integral of v·ν over a part of the sphere, which is at most π|v|; and
// term by term, no disc is larger than where its plane is nearest to the centre.
RayBounds BallConvolution::bounds(const std::vector<double>& a0, const std::vector<double>& a1,
                                  const std::vector<double>& rate, double speed) const {
    thread_local std::vector<char> known, open;
    thread_local BooleanSteps steps;
    const std::size_t count = half_spaces_.size();
    known.resize(count);
    for (std::size_t i = 0; i < count; ++i)
        known[i] = std::min(a0[i], a1[i]) >= 1 ? 0 : std::max(a0[i], a1[i]) <= -1 ? 1 : unknown;
    find_open(known, steps);
    open.assign(count, false);
    for (const BooleanStep& s : steps.steps) open[s.variable] = true;
    std::size_t varying = 0;
    RayBounds sum{1, 0, 0};
    for (std::size_t i = 0; i < count; ++i) {
        if (!open[i]) continue;
        ++varying;
        const RayBounds alone = half_space_bounds(a0[i], a1[i], rate[i]);
        sum.L += alone.L;
        const double lo = std::min(a0[i], a1[i]), hi = std::max(a0[i], a1[i]);
        const double nearest = lo > 0 ? lo : hi < 0 ? -hi : 0, farthest = std::min(1.0, std::max(-lo, hi));
        const double along = std::sqrt((1 - nearest * nearest) * std::max(0.0, speed * speed - rate[i] * rate[i]));
        const double growth = farthest * rate[i];  // |αα′|
        double change = 2 * (pi - 1) * growth + 2 * std::max(along, growth);
        if (uses_[i] == both_ways) change = 2 * change - 2 * pi * growth;
        sum.G += 0.75 / pi * rate[i] * change;
    }
    sum.L = std::min(sum.L, 0.75 * speed);
    if (varying == 1)
        for (std::size_t i = 0; i < count; ++i)
            if (open[i]) sum.G = half_space_bounds(a0[i], a1[i], rate[i]).G;
    return sum;
}

}  // namespace deburr
