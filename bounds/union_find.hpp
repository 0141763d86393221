// Disjoint sets of the numbers 0 … n − 1 that are joined step by step (union-find).
#pragma once
#include <numeric>
#include <vector>

namespace deburr {

class UnionFind {
public:
    explicit UnionFind(std::size_t n = 0) : parent_(n, 0) { std::iota(parent_.begin(), parent_.end(), 0); }

    std::size_t size() const { return parent_.size(); }
    /// The representative of i's set.
    int find(int i) {
        const auto up = [this](int k) -> int& { return parent_[k]; };
        while (up(i) != i) i = up(i) = up(up(i));
        return i;
    }
    /// Joins the sets of a and b; the representative of a's set represents both.
    void join(int a, int b) { parent_[find(b)] = find(a); }

private:
    std::vector<int> parent_;
};

}  // namespace deburr
