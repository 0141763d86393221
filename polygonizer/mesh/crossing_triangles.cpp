#include "polygonizer/mesh/crossing_triangles.hpp"

#include <algorithm>

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
    constexpr std::size_t most = 8192;  // triangles that one thread takes at a time
    std::vector<Found> found((mesh.triangles.size() + most - 1) / most);
    in_parallel_ranges(mesh.triangles.size(), most, [&](std::size_t begin, std::size_t end) {
        Found& own = found[begin / most];
        for (std::size_t s = begin; s < end; ++s) {
            if (s % check_interval == 0) throw_if_cancelled(cancel);
            const std::size_t first = own.pairs.size();
            tree.visit(tree.box(int(s)), [&](int t) {
                if (t <= int(s)) return true;
                ++own.looked;
                if (triangles_cross(mesh, mesh.triangles[s], mesh.triangles[t], slack))
                    own.pairs.push_back({int(s), t});
                return true;
            });
            std::sort(own.pairs.begin() + std::ptrdiff_t(first), own.pairs.end());
        }
    });
    std::vector<std::pair<int, int>> pairs;
    std::size_t looked = 0;
    for (const Found& f : found) {
        pairs.insert(pairs.end(), f.pairs.begin(), f.pairs.end());
        looked += f.looked;
    }
    if (looked_at) *looked_at = looked;
    return pairs;
}

std::size_t add_crossing(const Mesh& mesh, std::vector<int>& triangles, CancelFlag cancel) {
    const auto pairs = crossing_triangles(mesh, TriangleTree(mesh), cancel);
    for (const auto& [s, t] : pairs) triangles.insert(triangles.end(), {s, t});
    return pairs.size();
}

}  // namespace deburr
