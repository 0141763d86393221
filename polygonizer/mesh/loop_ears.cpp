#include "polygonizer/mesh/loop_ears.hpp"

#include <queue>
#include <tuple>

namespace deburr {
namespace {

struct Corner {
    Vec2 x;
    int vertex;
};

double cross(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }

// Sine of the triangle's least angle; negative if the triangle is clockwise.
double shape(Vec2 a, Vec2 b, Vec2 c) {
    const double ab = glm::distance(a, b), bc = glm::distance(b, c), ca = glm::distance(c, a);
    const double longest = std::max({ab, bc, ca}), shortest = std::min({ab, bc, ca});
    const double middle = ab + bc + ca - longest - shortest;
    return longest > 0 && middle > 0 ? cross(b - a, c - a) / (longest * middle) : 0;
}

std::vector<Corner> corners_of(const std::vector<int>& loop, const std::vector<Vec2>& plane_points) {
    std::vector<Corner> corners;
    for (std::size_t k = 0; k < loop.size(); ++k) corners.push_back({plane_points[k], loop[k]});
    return corners;
}

/// Inserts the loop into the ring by a bridge between the two nearest corners.
void join(std::vector<Corner>& ring, const std::vector<Corner>& loop) {
    std::size_t from = 0, to = 0;
    double nearest = infinity;
    for (std::size_t i = 0; i < ring.size(); ++i)
        for (std::size_t j = 0; j < loop.size(); ++j) {
            const Vec2 d = ring[i].x - loop[j].x;
            if (glm::dot(d, d) >= nearest) continue;
            nearest = glm::dot(d, d);
            from = i;
            to = j;
        }
    std::vector<Corner> there_and_back;
    for (std::size_t k = 0; k <= loop.size(); ++k) there_and_back.push_back(loop[(to + k) % loop.size()]);
    there_and_back.push_back(ring[from]);
    ring.insert(ring.begin() + long(from) + 1, there_and_back.begin(), there_and_back.end());
}

}  // namespace

std::vector<std::array<int, 3>> loop_ears(const std::vector<std::vector<int>>& loops,
                                          const std::vector<std::vector<Vec2>>& plane_points) {
    std::vector<Corner> ring = corners_of(loops[0], plane_points[0]);
    for (std::size_t k = 1; k < loops.size(); ++k) join(ring, corners_of(loops[k], plane_points[k]));
    const std::size_t n = ring.size();
    std::vector<std::size_t> next(n), before(n), version(n, 0);
    for (std::size_t k = 0; k < n; ++k) {
        next[k] = (k + 1) % n;
        before[k] = (k + n - 1) % n;
    }
    struct Ear {
        double shape;
        std::size_t corner, version;
        bool operator<(const Ear& o) const { return std::tie(shape, o.corner) < std::tie(o.shape, corner); }
    };
    // Corners where an edge runs back along itself; they wait until all others are gone, and leave no triangle.
    constexpr double spur = -2;
    std::priority_queue<Ear> ears;
    const auto offer = [&](std::size_t k) {
        const Corner &a = ring[before[k]], &b = ring[k], &c = ring[next[k]];
        const bool folded = a.vertex == b.vertex || b.vertex == c.vertex || c.vertex == a.vertex;
        ears.push({folded ? spur : shape(a.x, b.x, c.x), k, ++version[k]});
    };
    for (std::size_t k = 0; k < n; ++k) offer(k);
    std::vector<std::array<int, 3>> triangles;
    std::size_t left = n;
    while (left >= 3 && !ears.empty()) {
        const Ear ear = ears.top();
        ears.pop();
        const std::size_t k = ear.corner;
        if (ear.version != version[k]) continue;
        const std::size_t a = before[k], c = next[k];
        if (ear.shape > spur) triangles.push_back({ring[a].vertex, ring[k].vertex, ring[c].vertex});
        next[a] = c;
        before[c] = a;
        ++version[k];
        --left;
        offer(a);
        offer(c);
    }
    return triangles;
}

}  // namespace deburr
