#include "polygonizer/mesh/small_polygon.hpp"

#include <map>
#include <numeric>

#include "polygonizer/mesh/exact_orientation.hpp"

namespace deburr {

int quadrilateral_diagonal(const std::array<Vec2, 4>& x) {
    const auto may_part = [&](std::size_t k) {
        const std::size_t l = (k + 1) % 4, m = (k + 2) % 4, n = (k + 3) % 4;
        return orientation(x[k], x[l], x[m]) > 0 && orientation(x[m], x[n], x[k]) > 0;
    };
    // Sine of the least angle of the better shaped triangle beside the diagonal.
    const auto shape = [&](std::size_t k) {
        const auto sine = [&](std::size_t i, std::size_t j, std::size_t l) {
            const double ab = glm::distance(x[i], x[j]), bc = glm::distance(x[j], x[l]), ca = glm::distance(x[l], x[i]);
            const double longest = std::max({ab, bc, ca}), shortest = std::min({ab, bc, ca});
            return orientation(x[i], x[j], x[l]) / (longest * (ab + bc + ca - longest - shortest));
        };
        return std::max(sine(k, k + 1, k + 2), sine(k + 2, (k + 3) % 4, k));
    };
    const bool first = may_part(0), second = may_part(1);
    if (first && second) return shape(0) >= shape(1) ? 0 : 1;
    return first ? 0 : second ? 1 : -1;
}

std::vector<std::array<int, 3>> small_polygon(const std::vector<Vec2>& corners) {
    std::vector<int> ring(corners.size());
    std::iota(ring.begin(), ring.end(), 0);
    const auto at = [&](std::size_t k) { return corners[ring[k % ring.size()]]; };
    std::vector<std::array<int, 3>> triangles;
    while (ring.size() >= 3) {
        std::size_t best = ring.size();
        double most = 0;
        for (std::size_t k = 0; k < ring.size(); ++k) {
            const Vec2 a = at(k), b = at(k + 1), c = at(k + 2);
            const double longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
            const double height = orientation(a, b, c) / longest;
            bool empty = height > most;
            for (std::size_t j = k + 3; j < k + ring.size() && empty; ++j)
                empty = orientation(a, b, at(j)) < 0 || orientation(b, c, at(j)) < 0 || orientation(c, a, at(j)) < 0;
            if (!empty) continue;
            most = height;
            best = k;
        }
        if (best == ring.size()) best = 0;
        const std::size_t tip = (best + 1) % ring.size();
        triangles.push_back({ring[best], ring[tip], ring[(best + 2) % ring.size()]});
        ring.erase(ring.begin() + long(tip));
    }
    return triangles;
}

bool take_ring(std::vector<std::array<int, 3>>& triangles, int vertex, std::vector<int>& ring) {
    std::map<int, int> next;
    std::erase_if(triangles, [&](const std::array<int, 3>& t) {
        const auto at = std::find(t.begin(), t.end(), vertex);
        if (at == t.end()) return false;
        const auto k = std::size_t(at - t.begin());
        next[t[(k + 1) % 3]] = t[(k + 2) % 3];
        return true;
    });
    if (next.empty()) return false;
    int v = next.begin()->first;
    do {
        ring.push_back(v);
        const auto at = next.find(v);
        if (at == next.end()) return false;
        v = at->second;
    } while (v != ring[0] && ring.size() <= next.size());
    return ring.size() == next.size();
}

}  // namespace deburr
