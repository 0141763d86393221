// Sums of directed edges, as boundaries are.
#pragma once
#include <algorithm>
#include <utility>
#include <vector>

namespace deburr {

/// An edge and the way back cancel.
class EdgeChain {
public:
    void add(int a, int b, int times = 1) {
        if (a != b) edges_.push_back({{std::min(a, b), std::max(a, b)}, a < b ? times : -times});
    }
    /// Edges that do not cancel, with how often each is run through from its first end to its second.
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
