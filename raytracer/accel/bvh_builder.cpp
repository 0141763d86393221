// Builds the binary trees for Bvh8. Parts that no BSP has arranged are split by the surface-area heuristic [MacDonald &
// Booth 1990] in bins [Wald 2007].
#include <tbb/parallel_invoke.h>

#include <algorithm>

#include "raytracer/accel/bvh.hpp"

namespace deburr {
namespace {

constexpr int bins = 16;
// Ranges of fewer parts are split without a task of their own.
constexpr std::size_t parts_of_a_task = 4096;
// Below this depth ranges are halved by count, so that the tree's depth stays within what a ray's stack can hold.
constexpr int max_depth_by_area = 40;

Vec3 middle(const Box& b) { return 0.5 * b.lo + 0.5 * b.hi; }

struct Bin {
    Box box;
    std::size_t count = 0;
};

}  // namespace

int Bvh8::Builder::item(std::uint32_t number, const Box& box) {
    parts_.push_back({box, int(number), -1});
    return int(parts_.size()) - 1;
}

int Bvh8::Builder::join(int a, int b) {
    if (a == nothing) return b;
    if (b == nothing) return a;
    parts_.push_back({hull(box(a), box(b)), a, b});
    return int(parts_.size()) - 1;
}

int Bvh8::Builder::join_by_area(std::vector<int> parts) {
    std::erase(parts, nothing);
    if (parts.empty()) return nothing;
    const int first = int(parts_.size());
    parts_.resize(parts_.size() + parts.size() - 1);
    return split(parts, 0, parts.size(), first, 0);
}

// A range of n parts needs n − 1 joins, so the slots of each subtree in parts_ are known beforehand; the tree does not
// depend on the number of threads.
int Bvh8::Builder::split(std::vector<int>& order, std::size_t first, std::size_t end, int slot, int depth) {
    if (end - first == 1) return order[first];
    const auto box_at = [&](std::size_t i) -> const Box& { return box(order[i]); };
    Box middles;
    for (std::size_t i = first; i < end; ++i) middles = hull(middles, {middle(box_at(i)), middle(box_at(i))});
    double best = infinity;
    int best_axis = -1, best_bin = 0;
    const auto bin_of = [&](int part, int axis) {
        const double share = (middle(box(part))[axis] - middles.lo[axis]) / (middles.hi[axis] - middles.lo[axis]);
        return std::clamp(int(share * bins), 0, bins - 1);
    };
    const auto is_split = [&](int axis) { return depth < max_depth_by_area && middles.hi[axis] > middles.lo[axis]; };
    Bin bins_of[3][bins];
    for (std::size_t i = first; i < end; ++i)  // part by part, so that each scattered box is loaded once
        for (int axis = 0; axis < 3; ++axis)
            if (is_split(axis)) {
                Bin& bin = bins_of[axis][bin_of(order[i], axis)];
                bin.box = hull(bin.box, box_at(i));
                ++bin.count;
            }
    for (int axis = 0; axis < 3; ++axis) {
        if (!is_split(axis)) continue;
        const Bin* all = bins_of[axis];
        double upper_cost[bins];
        Bin sum;
        const auto add = [&](const Bin& bin) {
            sum.box = hull(sum.box, bin.box);
            sum.count += bin.count;
            return sum.count ? half_area(sum.box) * double(sum.count) : 0.0;
        };
        for (int k = bins - 1; k > 0; --k) upper_cost[k] = add(all[k]);
        sum = {};
        for (int k = 1; k < bins; ++k) {
            const double cost = add(all[k - 1]) + upper_cost[k];
            if (sum.count == 0 || sum.count == end - first || !(cost < best)) continue;
            best = cost;
            best_axis = axis;
            best_bin = k;
        }
    }
    std::size_t middle_one = first + (end - first) / 2;  // used where all middles coincide, or the tree is deep
    if (best_axis >= 0) {
        const auto upper =
            std::stable_partition(order.begin() + std::ptrdiff_t(first), order.begin() + std::ptrdiff_t(end),
                                  [&](int part) { return bin_of(part, best_axis) < best_bin; });
        middle_one = std::size_t(upper - order.begin());
    }
    Part to{{}, 0, 0};
    const auto lower_half = [&] { to.a = split(order, first, middle_one, slot + 1, depth + 1); };
    const auto upper_half = [&] { to.b = split(order, middle_one, end, slot + int(middle_one - first), depth + 1); };
    if (end - first < parts_of_a_task) {
        lower_half();
        upper_half();
    } else {
        tbb::parallel_invoke(lower_half, upper_half);
    }
    to.box = hull(box(to.a), box(to.b));
    parts_[slot] = to;
    return slot;
}

}  // namespace deburr
