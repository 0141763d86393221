#include "polygonizer/mesh/crossing_triangles.hpp"

#include <algorithm>

namespace deburr {

std::vector<std::pair<int, int>> crossing_triangles(const Mesh& mesh, const TriangleTree& tree, CancelFlag cancel,
                                                    std::size_t* looked_at) {
    constexpr std::size_t check_interval = 1024;
    // Where parts touch, vertices lie in facets up to the rounding of what computed them.
    const Box all = tree.box();
    const double rounding = all.empty() ? 0 : 1e-11 * std::max(largest(all.lo), largest(all.hi));
    std::vector<std::pair<int, int>> pairs;
    std::size_t looked = 0;
    for (std::size_t s = 0; s < mesh.triangles.size(); ++s) {
        if (s % check_interval == 0) throw_if_cancelled(cancel);
        const std::size_t first = pairs.size();
        tree.visit(tree.box(int(s)), [&](int t) {
            if (t <= int(s)) return true;
            ++looked;
            if (triangles_cross(mesh, mesh.triangles[s], mesh.triangles[t], rounding)) pairs.push_back({int(s), t});
            return true;
        });
        std::sort(pairs.begin() + std::ptrdiff_t(first), pairs.end());
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
