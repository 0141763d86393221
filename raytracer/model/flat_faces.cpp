#include "raytracer/model/flat_faces.hpp"

#include <algorithm>
#include <numeric>

#include "bounds/half_edges.hpp"
#include "bounds/sort_once.hpp"

namespace deburr {
namespace {

using Corners = std::array<int, 3>;

struct Plane {
    Vec3 normal{0.0};
    double offset = 0;
};

// The least-squares plane of these points, with its normal on the side of `outward`.
Plane fitted(const std::vector<Vec3>& vertices, const std::vector<int>& points, Vec3 outward) {
    Vec3 center(0.0);
    for (const int v : points) center += vertices[v] / double(points.size());
    Mat3 spread(0.0);
    for (const int v : points) {
        const Vec3 d = vertices[v] - center;
        spread += glm::outerProduct(d, d);
    }
    const Eigensystem e = eigensystem(spread);
    int least = 0;
    for (int k = 1; k < 3; ++k)
        if (e.values[k] < e.values[least]) least = k;
    Vec3 normal = e.vectors[least];
    // Components that are 0 up to rounding become 0, so that the normal is exactly along an axis.
    for (int k = 0; k < 3; ++k)
        if (std::abs(normal[k]) < 1e-9) normal[k] = 0;
    normal = glm::normalize(normal);
    if (glm::dot(normal, outward) < 0) normal = -normal;
    return {normal, glm::dot(normal, center)};
}

// The triangle across each edge; −1 where there is not exactly one.
std::vector<Corners> neighbours(const std::vector<Corners>& triangles) {
    std::vector<Corners> across(triangles.size(), {-1, -1, -1});
    each_edge(sorted_half_edges(triangles), [&](std::span<const HalfEdge> edge) {
        if (edge.size() != 2) return;
        across[edge[0].triangle][edge[0].k] = edge[1].triangle;
        across[edge[1].triangle][edge[1].k] = edge[0].triangle;
    });
    return across;
}

// The shortest translation that moves x onto all of the planes, as far as they intersect.
Vec3 onto(const std::vector<Plane>& planes, Vec3 x) {
    Mat3 square(0.0);
    Vec3 right(0.0);
    for (const Plane& p : planes) {
        square += glm::outerProduct(p.normal, p.normal);
        right += p.normal * (p.offset - glm::dot(p.normal, x));
    }
    const Eigensystem e = eigensystem(square);
    const double most = max_component(e.values);
    Vec3 way(0.0);
    for (int k = 0; k < 3; ++k)
        if (e.values[k] > 1e-6 * most) way += e.vectors[k] * (glm::dot(e.vectors[k], right) / e.values[k]);
    return way;
}

}  // namespace

void flatten_faces(std::vector<Vec3>& vertices, const std::vector<Corners>& triangles) {
    double scale = 0;
    for (const Vec3& v : vertices) scale = std::max(scale, largest(v));
    // 16 roundings of a float (2⁻²⁵), as positions may have been computed from one
    const double tolerance = 0x1p-21 * scale;
    std::vector<Vec3> areas;
    for (const Corners& t : triangles)
        areas.push_back(glm::cross(vertices[t[1]] - vertices[t[0]], vertices[t[2]] - vertices[t[0]]));
    std::vector<int> order(triangles.size());
    std::iota(order.begin(), order.end(), 0);
    const auto size = [&](int t) { return glm::dot(areas[t], areas[t]); };
    std::sort(order.begin(), order.end(), [&](int a, int b) { return size(a) != size(b) ? size(a) > size(b) : a < b; });
    const std::vector<Corners> across = neighbours(triangles);

    std::vector<std::vector<Plane>> planes_at(vertices.size());
    std::vector<char> done(triangles.size(), false);
    std::vector<int> face, todo, points;
    for (const int seed : order) {
        if (done[seed] || !(size(seed) > 0)) continue;
        const Vec3 normal = glm::normalize(areas[seed]);
        const double offset = glm::dot(normal, vertices[triangles[seed][0]]);
        // A small triangle determines its plane badly far away, so faces grow from their largest triangle.
        const auto lies_in = [&](int t) {
            constexpr double least_cosine = 0.9;
            for (const int v : triangles[t])
                if (std::abs(glm::dot(normal, vertices[v]) - offset) > tolerance) return false;
            return glm::dot(areas[t], normal) >= least_cosine * glm::length(areas[t]);
        };
        face.assign(1, seed);
        todo.assign(1, seed);
        done[seed] = true;
        while (!todo.empty()) {
            const int t = todo.back();
            todo.pop_back();
            for (const int next : across[t]) {
                if (next < 0 || done[next] || !lies_in(next)) continue;
                done[next] = true;
                face.push_back(next);
                todo.push_back(next);
            }
        }
        if (face.size() == 1) continue;
        points.clear();
        for (const int t : face) points.insert(points.end(), triangles[t].begin(), triangles[t].end());
        sort_once(points);
        const Plane plane = fitted(vertices, points, normal);
        for (const int v : points) planes_at[v].push_back(plane);
    }
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        if (planes_at[v].empty()) continue;
        for (int step = 0; step < 3; ++step) {
            const Vec3 way = onto(planes_at[v], vertices[v]);
            if (!(largest(way) <= 4 * tolerance)) break;
            vertices[v] += way;
        }
    }
}

}  // namespace deburr
