#include "polygonizer/surface.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "polygonizer/boundary_polygons.hpp"
#include "polygonizer/polygon_triangles.hpp"

namespace deburr {
namespace {

class Extraction : BoundaryPolygons {
public:
    Extraction(const Subspace& subspace, const Subdivision& subdivision, const SolidTree& solid)
        : BoundaryPolygons(subspace, subdivision, solid) {}

    Mesh run(std::vector<Origin>* origins) {
        join_flat();
        trace();
        straighten();
        separate_double_edges();
        return build(origins);
    }

private:
    int group(int p) {
        while (group_[std::size_t(p)] != p) p = group_[std::size_t(p)] = group_[std::size_t(group_[std::size_t(p)])];
        return p;
    }

    bool in_plane(const Polygon& p, const Polygon& plane) const {
        for (int h = p.first; h < p.first + p.count; ++h)
            if (std::abs(glm::dot(plane.normal, positions_[std::size_t(vertex_[std::size_t(h)])]) - plane.offset) >
                flat_slack())
                return false;
        return true;
    }
    double flat_slack() const { return 0.1 * complex_.tolerance; }

    void join_flat() {
        group_.resize(polygons_.size());
        std::iota(group_.begin(), group_.end(), 0);
        for (std::size_t h = 0; h < steps_.size(); ++h) {
            const int a = group(owner_[h]), b = group(owner_[std::size_t(twin_[h])]);
            if (a == b) continue;
            const Polygon &p = polygons_[std::size_t(a)], &q = polygons_[std::size_t(b)];
            if (p.leaf != q.leaf || p.material != q.material || p.normal == Vec3(0.0)) continue;
            if (glm::dot(p.normal, q.normal) < 1 - 1e-9) continue;
            const Polygon& other = polygons_[std::size_t(owner_[std::size_t(twin_[h])])];
            if (!in_plane(p, p) || !in_plane(q, p) || !in_plane(other, p)) continue;
            group_[std::size_t(b)] = a;
        }
    }

    bool is_border(int h) { return group(owner_[std::size_t(h)]) != group(owner_[std::size_t(twin_[std::size_t(h)])]); }

    // Half-edges between groups, each with the next one around its group.
    void trace() {
        next_.assign(steps_.size(), -1);
        before_.assign(steps_.size(), -1);
        for (std::size_t h = 0; h < steps_.size(); ++h) {
            if (!is_border(int(h))) continue;
            int n = next(int(h));
            while (!is_border(n)) n = next(twin_[std::size_t(n)]);
            next_[h] = n;
            before_[std::size_t(n)] = int(h);
        }
    }

    static std::pair<int, int> ends(int a, int b) { return std::minmax(a, b); }
    int head(int h) const { return vertex_[std::size_t(next_[std::size_t(h)])]; }

    // Takes out vertices on a straight line between two groups.
    void straighten() {
        std::map<std::pair<int, int>, int> known;
        std::vector<int> degree(positions_.size(), 0);
        for (std::size_t h = 0; h < steps_.size(); ++h) {
            if (next_[h] < 0) continue;
            ++degree[std::size_t(vertex_[h])];
            ++known[ends(vertex_[h], head(int(h)))];
        }
        for (std::size_t h = 0; h < steps_.size(); ++h) {
            // h runs from a to v, n from v to b; their twins back.
            if (next_[h] < 0) continue;
            while (true) {
                const int n = next_[h], v = vertex_[std::size_t(n)];
                const int a = vertex_[h], b = head(n);
                const int hb = twin_[h], nb = twin_[std::size_t(n)];
                if (degree[std::size_t(v)] != 2 || a == b || next_[std::size_t(nb)] != hb) break;
                if (next_[std::size_t(next_[std::size_t(n)])] == int(h)) break;     // a triangle stays one
                if (next_[std::size_t(next_[std::size_t(hb)])] == nb) break;
                const Vec3 line = positions_[std::size_t(b)] - positions_[std::size_t(a)];
                const Vec3 x = positions_[std::size_t(v)] - positions_[std::size_t(a)];
                const double along = glm::dot(x, line), length2 = glm::dot(line, line);
                if (along <= 0 || along >= length2) break;
                if (glm::length(x - line * (along / length2)) > flat_slack()) break;
                if (known.count(ends(a, b)) && known[ends(a, b)] > 0) break;
                known[ends(a, v)] -= 2;
                known[ends(v, b)] -= 2;
                known[ends(a, b)] += 2;
                // h and nb stay, and become each other's twins: a to b, and b to a.
                next_[h] = next_[std::size_t(n)];
                before_[std::size_t(next_[h])] = int(h);
                next_[std::size_t(nb)] = next_[std::size_t(hb)];
                before_[std::size_t(next_[std::size_t(nb)])] = nb;
                next_[std::size_t(n)] = next_[std::size_t(hb)] = -1;
                twin_[h] = nb;
                twin_[std::size_t(nb)] = int(h);
                degree[std::size_t(v)] = 0;
            }
        }
    }

    // Two edges between the same vertices: one gets a vertex in the middle.
    void separate_double_edges() {
        std::map<std::pair<int, int>, int> seen;
        const std::size_t n = steps_.size();
        for (std::size_t h = 0; h < n; ++h) {
            if (next_[h] < 0 || int(h) > twin_[h]) continue;
            const int a = vertex_[h], b = head(int(h));
            if (++seen[ends(a, b)] == 1) continue;
            const int middle = int(positions_.size());
            const int t = twin_[h];
            positions_.push_back(middle_of(a, b, owner_[h], owner_[std::size_t(t)]));
            const int second = insert_after(int(h), middle), back = insert_after(t, middle);
            twin_[h] = back;
            twin_[std::size_t(back)] = int(h);
            twin_[std::size_t(t)] = second;
            twin_[std::size_t(second)] = t;
        }
    }

    // The middle of two vertices, moved to the surface of either polygon if it is bent.
    Vec3 middle_of(int a, int b, int p, int q) const {
        Vec3 x = 0.5 * (positions_[std::size_t(a)] + positions_[std::size_t(b)]);
        const Polygon& polygon = polygons_[std::size_t(polygons_[std::size_t(p)].leaf >= 0 ? p : q)];
        const LocalDensity* density = density_of(polygon);
        if (!density) return x;
        constexpr int steps = 20;  // of Newton's method, which takes 4 where the surface is near
        const Vec3 start = x;
        const double reach = glm::length(positions_[std::size_t(a)] - positions_[std::size_t(b)]);
        for (int k = 0; k < steps; ++k) {
            const ValueGradient v = density->gradient_at(x);
            const double slope2 = glm::dot(v.gradient, v.gradient);
            if (!(slope2 > 0)) return start;
            x -= v.gradient * ((v.value - 0.5) / slope2);
        }
        return glm::length(x - start) <= reach ? x : start;
    }

    const LocalDensity* density_of(const Polygon& p) const {
        if (p.leaf < 0) return nullptr;
        const OpenLeaf* open = subdivision_.open(p.inner, p.leaf);
        if (!open) open = subdivision_.open(p.outer, p.leaf);
        return open ? open->density.get() : nullptr;
    }

    int insert_after(int h, int vertex) {
        const int fresh = int(steps_.size());
        steps_.push_back(steps_[std::size_t(h)]);
        owner_.push_back(owner_[std::size_t(h)]);
        vertex_.push_back(vertex);
        twin_.push_back(-1);
        next_.push_back(next_[std::size_t(h)]);
        before_.push_back(h);
        before_[std::size_t(next_[std::size_t(h)])] = fresh;
        next_[std::size_t(h)] = fresh;
        return fresh;
    }

    // A diagonal between two vertices that have an edge already gets a vertex in the middle.
    void separate_double_diagonals(std::vector<std::array<int, 3>>& triangles, std::map<int, int>& polygon_at) {
        std::map<std::pair<int, int>, int> uses;
        for (const auto& t : triangles)
            for (std::size_t k = 0; k < 3; ++k) ++uses[ends(t[k], t[(k + 1) % 3])];
        for (std::size_t i = 0; i < triangles.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                const int a = triangles[i][k], b = triangles[i][(k + 1) % 3], c = triangles[i][(k + 2) % 3];
                const auto key = ends(a, b);
                const bool on_border = borders_.count(key) > 0;
                const int count = uses[key];
                if (count < 2) continue;  // the border itself
                if (!on_border && count == 2 && (diagonals_.count(key) == 0)) continue;
                // The other triangle of this diagonal: it runs the other way.
                for (std::size_t j = i + 1; j < triangles.size(); ++j) {
                    auto& t = triangles[j];
                    std::size_t m = 0;
                    while (m < 3 && !(t[m] == b && t[(m + 1) % 3] == a)) ++m;
                    if (m == 3) continue;
                    const int d = t[(m + 2) % 3], middle = int(positions_.size());
                    positions_.push_back(middle_of(a, b, polygon_at.at(a), polygon_at.at(b)));
                    polygon_at[middle] = polygon_at.at(a);
                    t = {b, middle, d};
                    triangles[i] = {a, middle, c};
                    triangles.push_back({middle, b, c});
                    triangles.push_back({middle, a, d});
                    uses[key] -= 2;
                    break;
                }
            }
        for (const auto& [key, count] : uses)
            if (count >= 2) diagonals_.insert(key);
    }

    Vec3 outward(const Polygon& p, Vec3 x) const {
        if (p.leaf < 0) return p.normal;
        const LocalDensity* density = density_of(p);
        const Vec3 g = density ? density->gradient_at(x).gradient : Vec3(0.0);
        const double length = glm::length(g);
        if (!(length > 1e-12)) return p.normal;
        // The gradient points into the solid, or out of it where the leaf is subtracted.
        const bool subtracted = subspace_.side(p.inner, p.leaf) == Side::outside;
        return g * ((subtracted ? 1.0 : -1.0) / length);
    }

    Mesh build(std::vector<Origin>* origins) {
        for (std::size_t h = 0; h < steps_.size(); ++h)
            if (next_[h] >= 0) borders_.insert(ends(vertex_[h], head(int(h))));
        std::map<int, std::vector<std::vector<int>>> loops;  // by group: half-edges
        std::vector<char> done(steps_.size(), false);
        for (std::size_t h = 0; h < steps_.size(); ++h) {
            if (next_[h] < 0 || done[h]) continue;
            auto& loop = loops[group(owner_[h])].emplace_back();
            for (int at = int(h); !done[std::size_t(at)]; at = next_[std::size_t(at)]) {
                done[std::size_t(at)] = true;
                loop.push_back(at);
            }
        }
        Mesh mesh;
        std::vector<int> number;
        std::vector<std::vector<int>> normals_at;
        for (const auto& [g, rings] : loops) {
            const Polygon& plane = polygons_[std::size_t(g)];
            std::map<int, int> polygon_at;  // of a corner
            std::vector<std::vector<int>> corners;
            for (const auto& ring : rings) {
                corners.emplace_back();
                for (const int h : ring) {
                    corners.back().push_back(vertex_[std::size_t(h)]);
                    polygon_at.emplace(vertex_[std::size_t(h)], owner_[std::size_t(h)]);
                }
            }
            ++mesh.polygons;
            const auto corner_normal = [&](int v) {
                const Vec3 n = outward(polygons_[std::size_t(polygon_at.at(v))], positions_[std::size_t(v)]);
                for (const int known : normals_at[std::size_t(v)])
                    if (glm::length(mesh.normals[std::size_t(known)] - n) < 1e-6) return known;
                normals_at[std::size_t(v)].push_back(int(mesh.normals.size()));
                mesh.normals.push_back(n);
                return int(mesh.normals.size()) - 1;
            };
            std::vector<std::array<int, 3>> triangles = triangles_of(corners, positions_, plane.normal);
            separate_double_diagonals(triangles, polygon_at);
            number.resize(positions_.size(), -1);
            normals_at.resize(positions_.size());
            for (const auto& t : triangles) {
                Triangle triangle{};
                triangle.material = plane.material;
                for (std::size_t k = 0; k < 3; ++k) {
                    int& v = number[std::size_t(t[k])];
                    if (v < 0) {
                        v = int(mesh.positions.size());
                        mesh.positions.push_back(positions_[std::size_t(t[k])]);
                    }
                    triangle.vertex[k] = v;
                    triangle.normal[k] = corner_normal(t[k]);
                }
                mesh.triangles.push_back(triangle);
                if (origins)
                    origins->push_back(plane.leaf < 0 ? Origin{} : Origin{subspace_.origin(plane.inner), plane.leaf});
            }
        }
        return mesh;
    }

    std::vector<int> group_;                 // union-find over polygons
    std::vector<int> next_, before_;         // around a group; −1: within it
    std::set<std::pair<int, int>> borders_, diagonals_;  // edges of polygons; of triangles within
};

}  // namespace

Mesh surface(const Subspace& subspace, const Subdivision& subdivision, const SolidTree& solid,
             std::vector<Origin>* origins) {
    return Extraction(subspace, subdivision, solid).run(origins);
}

}  // namespace deburr
