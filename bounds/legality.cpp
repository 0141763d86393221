#include "bounds/legality.hpp"

#include <algorithm>
#include <deque>

#include "bounds/box_range.hpp"
#include "bounds/density_part.hpp"
#include "bounds/local_density.hpp"

namespace deburr {
namespace {

// Sums of legal densities exceed 1 by rounding; less than this shows nowhere.
constexpr double tolerance = 1e-6;
// ρ is evaluated at these fractions of a box's edges: off the middle, where no one puts planes.
constexpr double off_middle[3] = {0.4142, 0.4472, 0.4690};

// A box shorter than this fraction of the whole is not halved: faces that touch meet there, equal but for rounding.
constexpr double touching = 1e-9;

double excess(double rho) { return std::max(rho - 1, -rho); }

// The part of space where planes and their filters are.
Box reach_of(const DensityTree& tree) {
    double reach = 0;
    for (const HalfSpace& h : tree.half_spaces) reach = std::max(reach, std::abs(h.offset) + 2 * h.radius);
    return {Vec3(-reach - 1), Vec3(reach + 1)};
}

struct OpenBox {
    DensityTree tree;  // pruned to the box
    Box box;
};

// Searches for the point where ρ is farthest outside of [0, 1]. Half of the boxes are taken breadth first and half
// depth first: the one finds what is large, the other what is thin. The search ends once `nodes`, which is counted
// down, is spent.
IllegalDensity search(const DensityTree& tree, const Box& start, int boxes, std::int64_t& nodes) {
    IllegalDensity worst;
    double most = tolerance;
    std::deque<OpenBox> open;
    const auto examine = [&](const DensityTree& from, const Box& box) {
        nodes -= std::int64_t(from.nodes.size());
        Pruned here = prune(from, box);
        if (excess(here.range.lo) <= most && excess(here.range.hi) <= most) return;
        nodes -= 2 * std::int64_t(here.tree.nodes.size());
        const LocalDensity local(here.tree);
        const Range range = local.range(box);
        if (excess(range.lo) <= most && excess(range.hi) <= most) return;
        Vec3 x;
        for (int k = 0; k < 3; ++k) x[k] = box.lo[k] + off_middle[k] * (box.hi[k] - box.lo[k]);
        const double rho = local.at(x);
        if (excess(rho) > most) {
            most = excess(rho);
            worst.point = x;
            worst.value = rho;
        }
        open.push_back({std::move(here.tree), box});
    };
    examine(tree, start);
    for (int n = 0; n < boxes && !open.empty() && nodes > 0; n += 2) {
        const bool widest = n < boxes / 2;
        const OpenBox now = widest ? std::move(open.front()) : std::move(open.back());
        widest ? open.pop_front() : open.pop_back();
        int axis = 0;
        for (int k = 1; k < 3; ++k)
            if (now.box.hi[k] - now.box.lo[k] > now.box.hi[axis] - now.box.lo[axis]) axis = k;
        Box low = now.box, high = now.box;
        low.hi[axis] = high.lo[axis] = 0.5 * (now.box.lo[axis] + now.box.hi[axis]);
        if (now.box.hi[axis] - now.box.lo[axis] < touching * glm::length(start.hi - start.lo)) continue;
        examine(now.tree, low);
        examine(now.tree, high);
        if (most > 0.5) break;  // bad enough to be reported
    }
    return worst;
}

// The nodes to search. Of a chain that one line of the scene wrote only the whole is searched: partial sums are no more
// than it, and partial differences no less, unless an operand is illegal by itself.
std::vector<int> suspects(const DensityTree& tree) {
    std::vector<char> covered(tree.nodes.size(), false);
    for (const TreeNode& n : tree.nodes) {
        const auto cover = [&](int child) {
            const TreeNode& c = tree.nodes[child];
            if (c.op == n.op && c.line == n.line) covered[child] = true;
        };
        if (n.op == Op::sum) cover(n.b);
        if (n.op == Op::sum || n.op == Op::difference) cover(n.a);
    }
    std::vector<int> all;
    for (std::size_t i = 0; i < tree.nodes.size(); ++i)
        if ((tree.nodes[i].op == Op::sum || tree.nodes[i].op == Op::difference) && !covered[i]) all.push_back(int(i));
    return all;
}

// The number of nodes in the subtree of each node.
std::vector<std::int64_t> sizes(const DensityTree& tree) {
    std::vector<std::int64_t> size(tree.nodes.size(), 1);
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        const TreeNode& n = tree.nodes[i];
        if (n.op == Op::half_space || n.op == Op::constant) continue;
        size[i] += size[n.a] + (n.b >= 0 ? size[n.b] : 0);
    }
    return size;
}

}  // namespace

std::vector<IllegalDensity> find_illegal(const DensityTree& tree, LegalityEffort& effort) {
    const std::vector<int> roots = suspects(tree);
    std::vector<IllegalDensity> worst_of(roots.size());
    const std::vector<std::int64_t> size = sizes(tree);
    const Box reach = reach_of(tree);
    for (std::size_t k = roots.size(); k-- > 0;) {  // the largest first
        const TreeNode& n = tree.nodes[roots[k]];
        if (size[roots[k]] > effort.nodes) continue;
        const Box start = n.support >= 0 ? intersection(reach, tree.supports[n.support]) : reach;
        if (start.empty()) continue;
        std::int64_t share = effort.nodes / std::int64_t(k + 1);
        effort.nodes -= share;
        share -= size[roots[k]];
        worst_of[k] = search(part_below(tree, roots[k]), start, effort.boxes, share);
        effort.nodes += share;  // the part that the search did not use
        worst_of[k].op = n.op;
        worst_of[k].line = n.line;
    }
    std::vector<IllegalDensity> found;
    for (const IllegalDensity& worst : worst_of) {
        if (excess(worst.value) <= tolerance) continue;
        const auto same = std::find_if(found.begin(), found.end(), [&](const IllegalDensity& f) {
            return f.line == worst.line && f.op == worst.op;
        });
        if (same == found.end())
            found.push_back(worst);
        else if (excess(worst.value) > excess(same->value))
            *same = worst;
    }
    return found;
}

}  // namespace deburr
