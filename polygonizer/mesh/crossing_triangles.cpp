#include "polygonizer/mesh/crossing_triangles.hpp"

#include <algorithm>
#include <utility>

#include "bounds/in_parallel.hpp"

namespace deburr {

double touching_slack(const Box& box) {
    constexpr double rounding = 1e-11;
    return box.empty() ? 0 : rounding * std::max(largest(box.lo), largest(box.hi));
}

std::vector<std::pair<int, int>> crossing_triangles(const Mesh& mesh, const TriangleTree& tree, CancelFlag cancel,
                                                    std::size_t* looked_at) {
    constexpr std::size_t check_interval = 1024;
    const double slack = touching_slack(tree.box());
    struct Found {
        std::vector<std::pair<int, int>> pairs;
        std::size_t looked = 0;
    };
    constexpr std::size_t most = 4096;  // nodes of the tree that one thread takes at a time
    std::vector<Found> found((tree.nodes() + most - 1) / most);
    in_parallel_ranges(tree.nodes(), most, [&](std::size_t begin, std::size_t end) {
        Found& own = found[begin / most];
        for (std::size_t node = begin; node < end; ++node) {
            if (node % check_interval == 0) throw_if_cancelled(cancel);
            tree.visit_pairs(node, [&](int s, int t) {
                ++own.looked;
                if (s > t) std::swap(s, t);
                if (triangles_cross(mesh, mesh.triangles[s], mesh.triangles[t], slack)) own.pairs.push_back({s, t});
            });
        }
    });
    std::vector<std::pair<int, int>> pairs;
    std::size_t looked = 0;
    for (const Found& f : found) {
        pairs.insert(pairs.end(), f.pairs.begin(), f.pairs.end());
        looked += f.looked;
    }
    std::sort(pairs.begin(), pairs.end());
    if (looked_at) *looked_at = looked;
    return pairs;
}

std::size_t add_crossing(const Mesh& mesh, std::vector<int>& triangles, CancelFlag cancel) {
    const auto pairs = crossing_triangles(mesh, TriangleTree(mesh), cancel);
    for (const auto& [s, t] : pairs) triangles.insert(triangles.end(), {s, t});
    return pairs.size();
}

}  // namespace deburr
