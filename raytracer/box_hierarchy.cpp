#include "raytracer/box_hierarchy.hpp"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>

namespace deburr {
namespace {

constexpr int bins = 16;
// Smaller parts are not worth a task.
constexpr std::size_t boxes_of_a_task = 4096;
// From here on parts are halved, so that a ray's stack has room for every hierarchy.
constexpr int deepest_by_area = 64;

double area(const Box& b) {
    const Vec3 d = b.hi - b.lo;
    return d.x * d.y + d.y * d.z + d.z * d.x;
}

Vec3 middle(const Box& b) { return 0.5 * b.lo + 0.5 * b.hi; }

float below(double x) {
    const float f = float(x);
    return double(f) <= x ? f : std::nextafter(f, -std::numeric_limits<float>::infinity());
}

struct Bin {
    Box box;
    std::size_t count = 0;
};

}  // namespace

BoxHierarchy::BoxHierarchy(const std::vector<Box>& boxes) {
    if (boxes.empty()) return;
    for (const Box& box : boxes) bounds_ = hull(bounds_, box);
    std::vector<std::int32_t> order(boxes.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = std::int32_t(i);
    std::vector<Pair> pairs(std::max<std::size_t>(1, boxes.size() - 1));
    build(pairs, boxes, order, 0, 0, boxes.size(), 0);
    nodes_.reserve(pairs.size() / 2 + 1);
    add_node(pairs, pairs[0]);
}

std::int32_t BoxHierarchy::add_node(const std::vector<Pair>& pairs, const Pair& from) {
    std::pair<Box, std::int32_t> part[4] = {{from.box[0], from.child[0]}, {from.box[1], from.child[1]}};
    int count = 2;
    while (count < 4) {  // the largest pair is opened
        int widest = -1;
        for (int i = 0; i < count; ++i)
            if (part[i].second >= 0 && (widest < 0 || area(part[i].first) > area(part[widest].first))) widest = i;
        if (widest < 0) break;
        const Pair& inner = pairs[std::size_t(part[widest].second)];
        part[widest] = {inner.box[0], inner.child[0]};
        part[count++] = {inner.box[1], inner.child[1]};
    }
    const std::size_t number = nodes_.size();
    nodes_.emplace_back();
    for (int i = 0; i < 4; ++i) {
        const Box box = i < count ? part[i].first : Box{};
        for (int k = 0; k < 3; ++k) {
            nodes_[number].lo[k][i] = below(box.lo[k]);
            nodes_[number].hi[k][i] = -below(-box.hi[k]);
        }
        if (i >= count) continue;
        const std::int32_t child = part[i].second >= 0 ? add_node(pairs, pairs[std::size_t(part[i].second)]) : part[i].second;
        nodes_[number].child[i] = child;
    }
    return std::int32_t(number);
}

// n boxes have n − 1 pairs: where each part's are is known beforehand.
void BoxHierarchy::build(std::vector<Pair>& pairs, const std::vector<Box>& boxes, std::vector<std::int32_t>& order,
                         std::int32_t pair, std::size_t first, std::size_t end, int depth) {
    const auto box_at = [&](std::size_t i) -> const Box& { return boxes[std::size_t(order[i])]; };
    Pair& to = pairs[std::size_t(pair)];
    if (end - first == 1) {  // there is but one box: its second side is empty
        to.box[0] = box_at(first);
        to.child[0] = to.child[1] = ~order[first];
        return;
    }
    Box middles;
    for (std::size_t i = first; i < end; ++i) middles = hull(middles, {middle(box_at(i)), middle(box_at(i))});
    double best = infinity;
    int best_axis = -1, best_bin = 0;
    const auto bin_of = [&](std::size_t i, int axis) {
        const double share = (middle(box_at(i))[axis] - middles.lo[axis]) / (middles.hi[axis] - middles.lo[axis]);
        return std::clamp(int(share * bins), 0, bins - 1);
    };
    for (int axis = 0; axis < 3 && depth < deepest_by_area; ++axis) {
        if (!(middles.hi[axis] > middles.lo[axis])) continue;
        Bin all[bins];
        for (std::size_t i = first; i < end; ++i) {
            Bin& bin = all[bin_of(i, axis)];
            bin.box = hull(bin.box, box_at(i));
            ++bin.count;
        }
        double upper_cost[bins];
        Bin sum;
        const auto add = [&](const Bin& bin) {
            sum.box = hull(sum.box, bin.box);
            sum.count += bin.count;
            return sum.count ? area(sum.box) * double(sum.count) : 0.0;
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
    std::size_t split = first + (end - first) / 2;  // where all middles are one, or too deep
    if (best_axis >= 0) {
        std::vector<std::int32_t> upper;
        std::size_t at = first;
        for (std::size_t i = first; i < end; ++i) {
            if (bin_of(i, best_axis) < best_bin) order[at++] = order[i];
            else upper.push_back(order[i]);
        }
        std::copy(upper.begin(), upper.end(), order.begin() + std::ptrdiff_t(at));
        split = at;
    }
    const std::size_t begins[3] = {first, split, end};
    const std::int32_t inner[2] = {pair + 1, pair + std::int32_t(split - first)};
    for (int side = 0; side < 2; ++side) {
        Box box;
        for (std::size_t i = begins[side]; i < begins[side + 1]; ++i) box = hull(box, box_at(i));
        to.box[side] = box;
        to.child[side] = begins[side + 1] - begins[side] == 1 ? ~order[begins[side]] : inner[side];
    }
    const auto descend = [&](int side) {
        if (to.child[side] >= 0) build(pairs, boxes, order, inner[side], begins[side], begins[side + 1], depth + 1);
    };
    if (end - first < boxes_of_a_task) {
        descend(0);
        descend(1);
    } else {
        tbb::parallel_invoke([&] { descend(0); }, [&] { descend(1); });
    }
}

}  // namespace deburr
