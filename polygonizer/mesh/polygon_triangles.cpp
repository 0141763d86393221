#include "polygonizer/mesh/polygon_triangles.hpp"

#include <algorithm>
#include <tuple>

namespace deburr {
namespace {

struct Point {
    double x, y;
    int vertex;
};

double cross(const Point& a, const Point& b, const Point& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

double area(const std::vector<Point>& loop) {
    double sum = 0;
    for (std::size_t k = 1; k + 1 < loop.size(); ++k) sum += cross(loop[0], loop[k], loop[k + 1]);
    return sum;
}

bool segments_meet(const Point& a, const Point& b, const Point& c, const Point& d) {
    const double s = cross(a, b, c), t = cross(a, b, d), u = cross(c, d, a), v = cross(c, d, b);
    return ((s > 0) != (t > 0)) && ((u > 0) != (v > 0));
}

// Joins a hole by the shortest pair of edges that meets no other edge.
void join(std::vector<Point>& outer, const std::vector<Point>& hole, const std::vector<std::vector<Point>>& others) {
    struct Bridge {
        double length;
        std::size_t i, j;
    };
    std::vector<Bridge> bridges;
    for (std::size_t i = 0; i < outer.size(); ++i)
        for (std::size_t j = 0; j < hole.size(); ++j)
            bridges.push_back({std::hypot(outer[i].x - hole[j].x, outer[i].y - hole[j].y), i, j});
    std::sort(bridges.begin(), bridges.end(), [](const Bridge& a, const Bridge& b) {
        return std::tie(a.length, a.i, a.j) < std::tie(b.length, b.i, b.j);
    });
    const auto blocked = [&](const Point& a, const Point& b, const std::vector<Point>& loop) {
        for (std::size_t k = 0; k < loop.size(); ++k) {
            const Point &c = loop[k], &d = loop[(k + 1) % loop.size()];
            if (c.vertex == a.vertex || c.vertex == b.vertex || d.vertex == a.vertex || d.vertex == b.vertex) continue;
            if (segments_meet(a, b, c, d)) return true;
        }
        return false;
    };
    // The bridge must leave the corner into the polygon.
    const auto enters = [](const std::vector<Point>& loop, std::size_t k, const Point& to) {
        const std::size_t n = loop.size();
        const Point &before = loop[(k + n - 1) % n], &at = loop[k], &after = loop[(k + 1) % n];
        if (cross(before, at, after) >= 0) return cross(at, after, to) >= 0 && cross(before, at, to) >= 0;
        return cross(at, after, to) >= 0 || cross(before, at, to) >= 0;
    };
    Bridge best = bridges[0];
    for (const Bridge& b : bridges) {
        const Point &from = outer[b.i], &to = hole[b.j];
        if (!enters(outer, b.i, to) || !enters(hole, b.j, from)) continue;
        if (blocked(from, to, outer) || blocked(from, to, hole)) continue;
        if (std::any_of(others.begin(), others.end(), [&](const auto& o) { return blocked(from, to, o); })) continue;
        best = b;
        break;
    }
    std::vector<Point> joined(outer.begin(), outer.begin() + long(best.i) + 1);
    for (std::size_t k = 0; k <= hole.size(); ++k) joined.push_back(hole[(best.j + k) % hole.size()]);
    joined.insert(joined.end(), outer.begin() + long(best.i), outer.end());
    outer = std::move(joined);
}

// Sine of the least angle, 0 for triangles that are flat or wrong way round.
double shape(const Point& a, const Point& b, const Point& c) {
    const double twice = cross(a, b, c);
    const double ab = std::hypot(b.x - a.x, b.y - a.y), bc = std::hypot(c.x - b.x, c.y - b.y),
                 ca = std::hypot(a.x - c.x, a.y - c.y);
    const double longest = std::max({ab, bc, ca}), shortest = std::min({ab, bc, ca});
    const double middle = ab + bc + ca - longest - shortest;
    return longest > 0 && middle > 0 ? twice / (longest * middle) : 0;
}

}  // namespace

std::vector<std::array<int, 3>> triangles_of(const std::vector<std::vector<int>>& loops,
                                             const std::vector<Vec3>& positions, Vec3 normal) {
    if (loops.size() == 1 && loops[0].size() == 3) return {{loops[0][0], loops[0][1], loops[0][2]}};
    // Seen along the axis nearest to the normal, so that flush coordinates stay as they are.
    const Vec3 m = glm::abs(normal);
    const int drop = m.x >= m.y && m.x >= m.z ? 0 : m.y >= m.z ? 1 : 2;
    int ix = (drop + 1) % 3, iy = (drop + 2) % 3;
    if (normal[drop] < 0) std::swap(ix, iy);
    const auto flatten = [&](const std::vector<int>& loop, std::vector<Point>& flat) {
        flat.clear();
        for (const int v : loop) {
            const Vec3& x = positions[std::size_t(v)];
            flat.push_back({x[ix], x[iy], v});
        }
    };
    thread_local std::vector<Point> ring;
    if (loops.size() == 1) {
        flatten(loops[0], ring);
    } else {
        std::vector<std::vector<Point>> flat(loops.size());
        for (std::size_t k = 0; k < loops.size(); ++k) flatten(loops[k], flat[k]);
        std::size_t outer = 0;
        for (std::size_t k = 1; k < flat.size(); ++k)
            if (area(flat[k]) > area(flat[outer])) outer = k;
        std::swap(flat[0], flat[outer]);
        ring = std::move(flat[0]);
        flat.erase(flat.begin());
        std::sort(flat.begin(), flat.end(), [](const auto& a, const auto& b) { return a[0].x < b[0].x; });
        while (!flat.empty()) {
            const auto hole = std::move(flat.front());
            flat.erase(flat.begin());
            join(ring, hole, flat);
        }
    }

    std::vector<std::array<int, 3>> out;
    out.reserve(ring.size() - 2);
    constexpr std::size_t large = 400;  // corners beyond which the first good ear is taken
    // An ear holds no other corner, and none is on its sides, to rounding. Where the polygon touches itself,
    // corners lie on the sides of every ear: then none within has to do.
    double widest = 0;
    for (const Point& p : ring) widest = std::max({widest, std::abs(p.x - ring[0].x), std::abs(p.y - ring[0].y)});
    const double on_side = 1e-14 * widest * widest;
    const auto best_ear = [&](bool sides_too) {
        const std::size_t n = ring.size();
        std::size_t best = n;
        double best_shape = 0;
        for (std::size_t k = 0; k < n; ++k) {
            const Point &a = ring[(k + n - 1) % n], &b = ring[k], &c = ring[(k + 1) % n];
            if (a.vertex == c.vertex) continue;
            const double s = shape(a, b, c);
            if (s <= best_shape || s < 1e-9) continue;
            bool empty = true;
            for (std::size_t j = 0; j < n && empty; ++j) {
                const Point& p = ring[j];
                if (p.vertex == a.vertex || p.vertex == b.vertex || p.vertex == c.vertex) continue;
                const double inner = std::min({cross(a, b, p), cross(b, c, p), cross(c, a, p)});
                empty = sides_too ? inner < -on_side : inner <= 0;
            }
            if (!empty) continue;
            best = k;
            best_shape = s;
            if (n > large && s > 0.1) break;
        }
        return best;
    };
    while (ring.size() > 3) {
        const std::size_t n = ring.size();
        std::size_t best = best_ear(true);
        if (best == n) best = best_ear(false);
        if (best == n) {
            double best_shape = -infinity;
            best = 0;
            for (std::size_t k = 0; k < n; ++k) {
                const Point &a = ring[(k + n - 1) % n], &b = ring[k], &c = ring[(k + 1) % n];
                const double s = shape(a, b, c);
                if (a.vertex == c.vertex || s <= best_shape) continue;
                best_shape = s;
                best = k;
            }
        }
        out.push_back({ring[(best + n - 1) % n].vertex, ring[best].vertex, ring[(best + 1) % n].vertex});
        ring.erase(ring.begin() + long(best));
    }
    out.push_back({ring[0].vertex, ring[1].vertex, ring[2].vertex});
    return out;
}

}  // namespace deburr
