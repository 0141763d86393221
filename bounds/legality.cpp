#include "bounds/legality.hpp"

#include <algorithm>
#include <deque>

#include "bounds/box_range.hpp"
#include "bounds/local_density.hpp"

namespace deburr {
namespace {

// Sums of what is legal pass 1 by rounding; nothing to be seen comes of less than this.
constexpr double tolerance = 1e-6;
// Points where ρ is looked at lie off the middle, where no one puts planes.
constexpr double off_middle[3] = {0.4142, 0.4472, 0.4690};

// Of the whole, a box is not halved: faces that touch are there, and are equal but for rounding.
constexpr double thinnest = 1e-9;

double excess(double rho) { return std::max(rho - 1, -rho); }

// Where the planes of a tree are, and a radius around.
Box reach_of(const DensityTree& tree) {
    double reach = 0;
    for (const HalfSpace& h : tree.half_spaces) reach = std::max(reach, std::abs(h.offset) + 2 * h.radius);
    return {Vec3(-reach - 1), Vec3(reach + 1)};
}

struct Candidate {
    DensityTree tree;  // pruned to the box
    Box box;
};

// Worst point found in [0, 1]'s outside; half of the boxes are taken widest first, half deepest
// first: the one finds what is large, the other what is thin.
IllegalDensity search(const DensityTree& tree, const Box& start, int boxes) {
    IllegalDensity worst;
    double most = tolerance;
    std::deque<Candidate> open;
    const auto look = [&](const DensityTree& from, const Box& box) {
        Pruned here = prune(from, box);
        if (excess(here.range.lo) <= most && excess(here.range.hi) <= most) return;
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
    look(tree, start);
    for (int n = 0; n < boxes && !open.empty(); n += 2) {
        const bool widest = n < boxes / 2;
        const Candidate now = widest ? std::move(open.front()) : std::move(open.back());
        widest ? open.pop_front() : open.pop_back();
        int axis = 0;
        for (int k = 1; k < 3; ++k)
            if (now.box.hi[k] - now.box.lo[k] > now.box.hi[axis] - now.box.lo[axis]) axis = k;
        Box low = now.box, high = now.box;
        low.hi[axis] = high.lo[axis] = 0.5 * (now.box.lo[axis] + now.box.hi[axis]);
        if (now.box.hi[axis] - now.box.lo[axis] < thinnest * glm::length(start.hi - start.lo)) continue;
        look(now.tree, low);
        look(now.tree, high);
        if (most > 0.5) break;  // bad enough to be told
    }
    return worst;
}

}  // namespace

std::vector<IllegalDensity> find_illegal(const DensityTree& tree, int boxes) {
    const auto suspect = [](Op op) { return op == Op::sum || op == Op::difference; };
    // Partial sums of a chain are no more than the whole.
    std::vector<char> covered(tree.nodes.size(), false);
    for (const TreeNode& n : tree.nodes)
        if (n.op == Op::sum)
            for (const int child : {n.a, n.b}) {
                const TreeNode& c = tree.nodes[std::size_t(child)];
                if (c.op == Op::sum && c.line == n.line) covered[std::size_t(child)] = true;
            }
    std::vector<IllegalDensity> found;
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        const TreeNode& n = tree.nodes[i];
        if (!suspect(n.op) || covered[i]) continue;
        DensityTree part = tree;
        part.nodes.resize(i + 1);
        Box start = reach_of(tree);
        if (n.support >= 0) start = intersection(start, tree.supports[std::size_t(n.support)]);
        if (start.empty()) continue;
        IllegalDensity worst = search(part, start, boxes);
        if (excess(worst.value) <= tolerance) continue;
        worst.op = n.op;
        worst.line = n.line;
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
