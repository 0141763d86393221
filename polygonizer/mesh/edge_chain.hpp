// Sums of directed edges, as boundaries of surfaces are.
#pragma once
#include <algorithm>
#include <utility>
#include <vector>

namespace deburr {

/// A sum of directed edges, in which an edge and its reverse cancel.
class EdgeChain {
public:
    /// Adds the edge from vertex a to vertex b, `times` times.
    void add(int a, int b, int times = 1) {
        if (a != b) edges_.push_back({{std::min(a, b), std::max(a, b)}, a < b ? times : -times});
    }
    /// The edges that do not cancel, as ((lower vertex, higher vertex), times) in order of vertices; `times` is
    /// negative where the edge runs from the higher vertex to the lower.
    std::vector<std::pair<std::pair<int, int>, int>> rest() {
        std::sort(edges_.begin(), edges_.end());
        std::vector<std::pair<std::pair<int, int>, int>> rest;
        for (const auto& [ends, times] : edges_)
            if (!rest.empty() && rest.back().first == ends)
                rest.back().second += times;
            else
                rest.push_back({ends, times});
        std::erase_if(rest, [](const auto& edge) { return edge.second == 0; });
        return rest;
    }

private:
    std::vector<std::pair<std::pair<int, int>, int>> edges_;
};

}  // namespace deburr
