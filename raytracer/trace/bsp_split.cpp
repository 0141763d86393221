#include "raytracer/trace/bsp_split.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace deburr {
namespace {

// The cost of a density depends on its number of half-spaces: up to three it is mostly a product, beyond that a sum of
// products. CSG adds a cost for each leaf. These costs and those of bsp_split.hpp were chosen by the times to build and
// trace csg_examples, variable_rounding, staplers and hole_punch.
constexpr double cost_soft = 5.0, cost_half_space = 0.5;
constexpr double cost_further_half_space = 10.0, cost_csg_leaf = 10.0;
constexpr int few_factors = 3;

// A cell is split only if that saves at least this much for each ray through the whole scene: a split costs some 4,000
// units, which pays off after ten million rays. Chosen with a plate of 1,000 holes, where ten times as many cells took
// five times as long to build and were no faster. A cell of a model (a triangle mesh) must save ten times as much:
// cells along every edge of 500 to 1,000,000 triangles would take gigabytes. For other fields the least gain is 0,
// since the cost of their evaluation is not known here.
constexpr double least_gain_of_densities = 4e-4, least_gain_of_model = 4e-3;

// Split candidates that are evaluated together.
constexpr std::size_t trials_together = 8;

double cost(const LocalSolidSize& size) {
    if (size.side != Side::straddling) return 0;
    if (size.half_spaces <= 1) return cost_flat;
    return cost_soft + cost_half_space * size.half_spaces +
           cost_further_half_space * std::max(0, size.half_spaces - few_factors) +
           (size.leaves > 1 ? cost_csg_leaf * size.leaves : 0);
}

double least_gain_of(const std::vector<BspItem>& items) {
    if (is_model(items)) return least_gain_of_model;
    for (const BspItem& item : items)
        for (const SolidLeaf& leaf : item.tree->leaves)
            if (leaf.field && !leaf.field->is_density()) return 0;
    return least_gain_of_densities;
}

}  // namespace

BspCost cost_of(const std::vector<BspItem>& items) {
    BspCost all;
    for (const BspItem& item : items) {
        all.cost += cost(item.size);
        all.half_spaces += item.size.half_spaces;
    }
    return all;
}

bool is_model(const std::vector<BspItem>& items) {
    return items.size() == 1 && items[0].tree->leaves.size() == 1 && items[0].tree->leaves[0].field &&
           items[0].tree->leaves[0].field->is_density();
}

double BspSplitter::least_gain(const Box& cell, const std::vector<BspItem>& items) const {
    return least_gain_of(items) * area(world_) / area(cell);
}

BspSplit BspSplitter::best(const Box& cell, const std::vector<BspItem>& items, int half_spaces) const {
    if (is_model(items) && half_spaces > few_half_spaces)
        if (const BspSplit split = middle(cell, items[0]); split.axis >= 0) return split;
    return half_spaces <= few_half_spaces || items.size() == 1 ? best_local(cell, items, half_spaces)
                                                               : best_of_boxes(cell, items);
}

// Takes the plane as the best split if its expected cost is less. `low` and `high` are the costs of the cell's halves.
inline void BspSplitter::consider(BspSplit& best, const Box& cell, int axis, double position, double low,
                                  double high) const {
    const double whole = area(cell);
    if (!(whole > 0)) return;
    const double pl = area(half_of(cell, axis, position, false)) / whole;
    const double pu = area(half_of(cell, axis, position, true)) / whole;
    const double total = cost_node + pl * low + pu * high;
    if (total < best.cost) best = {total, position, axis};
}

// Adds the ends of the item's box, and the positions where its half-spaces across the axis begin and cease to vary.
inline void BspSplitter::add_ends(const BspItem& item, int axis, std::vector<double>& at) const {
    at.push_back(item.box.lo[axis] - 2 * margin_);
    at.push_back(item.box.hi[axis] + 2 * margin_);
    if (item.size.half_spaces > few_half_spaces) return;
    const auto add = [&](const std::vector<HalfSpace>& planes) {
        for (const HalfSpace& h : planes) {
            if (std::abs(h.normal[axis]) < 1 - 1e-9) continue;
            const double position = h.offset / h.normal[axis];
            at.push_back(position - h.radius - 2 * margin_);
            at.push_back(position + h.radius + 2 * margin_);
        }
    };
    for (const SolidLeaf& leaf : item.tree->leaves) {
        add(leaf.density.half_spaces);
        if (leaf.field) add(leaf.field->planes());
    }
}

// Split candidates on one axis, sorted: the ends of boxes, the places where half-spaces begin and cease to vary, and
// even steps between.
std::vector<double> BspSplitter::candidates(const Box& cell, const std::vector<BspItem>& items, int axis) const {
    std::vector<double> at;
    Box part;
    for (const BspItem& item : items) {
        part = hull(part, intersection(item.box, cell));
        add_ends(item, axis, at);
    }
    part = intersection(part, world_);
    for (int k = 1; k <= 3; ++k) at.push_back(part.lo[axis] + (part.hi[axis] - part.lo[axis]) * k / 4);
    const double lo = std::max(cell.lo[axis], world_.lo[axis]) + smallest_;
    const double hi = std::min(cell.hi[axis], world_.hi[axis]) - smallest_;
    std::erase_if(at, [&](double x) { return !(x > lo && x < hi); });
    std::sort(at.begin(), at.end());
    at.erase(std::unique(at.begin(), at.end(), [&](double a, double b) { return b - a < smallest_; }), at.end());
    return at;
}

// A candidate of best_local().
struct BspSplitter::Trial {
    int axis;
    double position, sum[2];  // of costs below and above the plane
};

// Adds up what the items would cost on either side of each trial's plane.
inline void BspSplitter::evaluate(const Box& cell, const std::vector<BspItem>& items, std::span<Trial> trials) const {
    Box parts[2 * trials_together];
    double* sums[2 * trials_together];
    LocalSolidSize sizes[2 * trials_together];
    for (const BspItem& item : items) {
        std::size_t count = 0;
        for (Trial& trial : trials)
            for (const bool upper : {false, true}) {
                const Box part = half_of(cell, trial.axis, trial.position, upper);
                if (misses(item, part)) continue;  // costs nothing
                parts[count] = inflated(part, margin_);
                sums[count++] = &trial.sum[upper];
            }
        local_sizes(*item.tree, {parts, count}, sizes);
        for (std::size_t k = 0; k < count; ++k) *sums[k] += cost(sizes[k]);
    }
}

// The best split by what pruning leaves of the items on either side.
BspSplit BspSplitter::best_local(const Box& cell, const std::vector<BspItem>& items, int half_spaces) const {
    std::vector<Trial> trials;
    for (int axis = 0; axis < 3; ++axis)
        for (const double position : candidates(cell, items, axis)) trials.push_back({axis, position, {0, 0}});
    const std::size_t blocks = (trials.size() + trials_together - 1) / trials_together;
    const auto evaluate_block = [&](std::size_t block) {
        const std::size_t first = block * trials_together;
        evaluate(cell, items, std::span(trials).subspan(first, std::min(trials_together, trials.size() - first)));
    };
    if (half_spaces < half_spaces_of_a_task)
        for (std::size_t i = 0; i < blocks; ++i) evaluate_block(i);
    else
        tbb::parallel_for(std::size_t(0), blocks, evaluate_block);
    BspSplit best;
    for (const Trial& l : trials) consider(best, cell, l.axis, l.position, l.sum[0], l.sum[1]);
    return best;
}

// The middle of the longest side of the part of a model that is in the cell, if that is long compared with the model's
// filter; splitting then always gains, so costs are not compared.
BspSplit BspSplitter::middle(const Box& cell, const BspItem& item) const {
    const Box part = intersection(intersection(item.box, cell), world_);
    if (part.empty()) return {};
    const Vec3 size = part.hi - part.lo;
    const int axis = greatest_axis(size);
    constexpr double long_side = 8;  // in radii
    if (size[axis] < std::max(2 * smallest_, long_side * item.tree->leaves[0].field->filter_radius())) return {};
    return {0, 0.5 * (part.lo[axis] + part.hi[axis]), axis};
}

// The best split among the ends of the items' boxes, found by one sweep along each axis.
BspSplit BspSplitter::best_of_boxes(const Box& cell, const std::vector<BspItem>& items) const {
    BspSplit best;
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<std::pair<double, double>> begin, end;  // position, cost
        double above = 0;
        for (const BspItem& item : items) {
            const double c = cost(item.size);
            begin.push_back({item.box.lo[axis] - 2 * margin_, c});
            end.push_back({item.box.hi[axis] + 2 * margin_, c});
            above += c;
        }
        std::sort(begin.begin(), begin.end());
        std::sort(end.begin(), end.end());
        const double lo = std::max(cell.lo[axis], world_.lo[axis]) + smallest_;
        const double hi = std::min(cell.hi[axis], world_.hi[axis]) - smallest_;
        double below = 0;
        std::size_t b = 0, e = 0;
        while (b < begin.size() || e < end.size()) {
            const bool ends = e < end.size() && (b >= begin.size() || end[e].first <= begin[b].first);
            const double position = ends ? end[e].first : begin[b].first;
            // A box that ends here is no longer above; one that begins here is not yet below.
            while (e < end.size() && end[e].first <= position) above -= end[e++].second;
            if (position > lo && position < hi) consider(best, cell, axis, position, below, above);
            while (b < begin.size() && begin[b].first <= position) below += begin[b++].second;
        }
    }
    return best;
}

}  // namespace deburr
