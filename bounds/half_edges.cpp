#include "bounds/half_edges.hpp"

#include <algorithm>
#include <tuple>

namespace deburr {

std::vector<HalfEdge> sorted_half_edges(std::span<const std::array<int, 3>> triangles) {
    std::vector<HalfEdge> all;
    all.reserve(3 * triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const int a = triangles[t][k], b = triangles[t][(k + 1) % 3];
            all.push_back({std::min(a, b), std::max(a, b), a < b, int(t), k});
        }
    std::sort(all.begin(), all.end(), [](const HalfEdge& a, const HalfEdge& b) {
        return std::tie(a.lo, a.hi, a.triangle, a.k) < std::tie(b.lo, b.hi, b.triangle, b.k);
    });
    return all;
}

}  // namespace deburr
