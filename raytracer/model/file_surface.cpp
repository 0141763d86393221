#include "raytracer/model/file_surface.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>

#include "bounds/half_edges.hpp"
#include "bounds/sort_once.hpp"
#include "bounds/union_find.hpp"

namespace deburr {

using Corners = ClosedMesh::Corners;

FileSurface welded(const TriangleSoup& soup) {
    FileSurface to;
    std::vector<int> order(soup.vertices.size()), number(soup.vertices.size());
    std::iota(order.begin(), order.end(), 0);
    const auto key = [&](int i) {
        const Vec3 v = soup.vertices[i] + 0.0;  // turns −0 into 0
        return std::tuple(v.x, v.y, v.z);
    };
    std::sort(order.begin(), order.end(), [&](int a, int b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
    std::vector<int> first(soup.vertices.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        first[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? first[order[i - 1]] : order[i];
    for (std::size_t i = 0; i < first.size(); ++i)
        if (first[i] == int(i)) {
            number[i] = int(to.vertices.size());
            to.vertices.push_back(soup.vertices[i] + 0.0);
        }
    for (const auto& t : soup.triangles)
        to.triangles.push_back({number[first[t[0]]], number[first[t[1]]], number[first[t[2]]]});
    return to;
}

void drop_collapsed(FileSurface& surface) {
    std::erase_if(surface.triangles, [](const Corners& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
}

std::size_t drop_doubles(FileSurface& surface) {
    struct Key {
        Corners sorted;
        bool even;  // orientation of the sorted corners
        int at;
    };
    std::vector<Key> keys;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        Corners c = surface.triangles[t];
        std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
        const bool even = c[1] < c[2];
        if (!even) std::swap(c[1], c[2]);
        keys.push_back({c, even, int(t)});
    }
    std::sort(keys.begin(), keys.end(),
              [](const Key& a, const Key& b) { return a.sorted != b.sorted ? a.sorted < b.sorted : a.at < b.at; });
    std::vector<char> gone(surface.triangles.size(), false);
    for (std::size_t i = 0; i < keys.size();) {
        std::size_t end = i;
        bool any[2] = {false, false};
        for (; end < keys.size() && keys[end].sorted == keys[i].sorted; ++end) any[keys[end].even] = true;
        for (std::size_t k = i; k < end; ++k) gone[keys[k].at] = (any[0] && any[1]) || k > i;
        i = end;
    }
    std::vector<Corners> left;
    for (std::size_t t = 0; t < gone.size(); ++t)
        if (!gone[t]) left.push_back(surface.triangles[t]);
    const std::size_t dropped = surface.triangles.size() - left.size();
    surface.triangles = std::move(left);
    return dropped;
}

Openness openness(const FileSurface& surface) {
    Openness o;
    each_edge(sorted_half_edges(surface.triangles), [&](std::span<const HalfEdge> edge) {
        const int lo = edge[0].lo, hi = edge[0].hi;
        if (edge.size() % 2 != 0) {
            if (o.open++ == 0) o.place = 0.5 * (surface.vertices[lo] + surface.vertices[hi]);
            o.rim.insert(o.rim.end(), {lo, hi});
        } else {
            const auto up = std::count_if(edge.begin(), edge.end(), [](const HalfEdge& e) { return e.up; });
            o.unturned += std::size_t(up) * 2 != edge.size();
        }
    });
    sort_once(o.rim);
    return o;
}

void weld_rim(FileSurface& surface, const std::vector<int>& rim, double distance) {
    std::vector<int> order = rim;
    std::sort(order.begin(), order.end(), [&](int a, int b) {
        return surface.vertices[a].x != surface.vertices[b].x ? surface.vertices[a].x < surface.vertices[b].x : a < b;
    });
    UnionFind same(surface.vertices.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        for (std::size_t k = i + 1; k < order.size(); ++k) {
            const Vec3 d = surface.vertices[order[k]] - surface.vertices[order[i]];
            if (d.x > distance) break;
            if (glm::dot(d, d) <= distance * distance)
                same.join(std::min(order[i], order[k]), std::max(order[i], order[k]));
        }
    for (Corners& t : surface.triangles)
        for (int& v : t) v = same.find(v);
    drop_collapsed(surface);
}

std::vector<int> shells_of(const FileSurface& surface, int& count) {
    UnionFind joined(surface.triangles.size());
    each_edge(sorted_half_edges(surface.triangles), [&](std::span<const HalfEdge> edge) {
        if (edge.size() == 2) joined.join(edge[0].triangle, edge[1].triangle);
    });
    std::vector<int> shell(surface.triangles.size()), number(surface.triangles.size(), -1);
    count = 0;
    for (std::size_t t = 0; t < shell.size(); ++t) {
        int& n = number[joined.find(int(t))];
        if (n < 0) n = count++;
        shell[t] = n;
    }
    return shell;
}

long turn_alike(FileSurface& surface) {
    std::vector<std::array<int, 3>> neighbour(surface.triangles.size(), {-1, -1, -1});
    std::vector<std::array<char, 3>> agrees(surface.triangles.size(), {true, true, true});
    each_edge(sorted_half_edges(surface.triangles), [&](std::span<const HalfEdge> edge) {
        if (edge.size() != 2) return;
        for (std::size_t i = 0; i < 2; ++i) {
            neighbour[edge[i].triangle][edge[i].k] = edge[1 - i].triangle;
            agrees[edge[i].triangle][edge[i].k] = edge[0].up != edge[1].up;
        }
    });
    std::vector<signed char> turned(surface.triangles.size(), -1);
    std::vector<int> todo;
    long total = 0;
    for (std::size_t seed = 0; seed < turned.size(); ++seed) {
        if (turned[seed] >= 0) continue;
        turned[seed] = 0;
        todo.assign(1, int(seed));
        std::vector<int> all;
        while (!todo.empty()) {
            const int t = todo.back();
            todo.pop_back();
            all.push_back(t);
            for (int k = 0; k < 3; ++k) {
                const int next = neighbour[t][k];
                if (next < 0) continue;
                const auto wanted = static_cast<signed char>(agrees[t][k] ? turned[t] : 1 - turned[t]);
                if (turned[next] < 0) {
                    turned[next] = wanted;
                    todo.push_back(next);
                } else if (turned[next] != wanted) {
                    return -1;
                }
            }
        }
        // The smaller part is taken to be wrong.
        const auto flipped = std::count_if(all.begin(), all.end(), [&](int t) { return turned[t] == 1; });
        const bool other = 2 * flipped > long(all.size());
        for (const int t : all)
            if ((turned[t] == 1) != other) std::swap(surface.triangles[t][1], surface.triangles[t][2]);
        total += other ? long(all.size()) - flipped : flipped;
    }
    return total;
}

}  // namespace deburr
