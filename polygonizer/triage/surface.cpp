#include "polygonizer/triage/surface.hpp"

#include <algorithm>
#include <cstdint>

#include "bounds/union_find.hpp"
#include "polygonizer/mesh/polygon_triangles.hpp"
#include "polygonizer/triage/boundary_polygons.hpp"

namespace deburr {
namespace {

// A hash set of pairs of vertices.
class EdgeSet {
public:
    using Ends = std::pair<int, int>;

    bool has(Ends ends) const { return !slots_.empty() && slots_[slot_of(ends)] == ends; }
    /// Adds a pair; false if it is in the set already.
    bool add(Ends ends) {
        if (2 * (count_ + 1) > slots_.size()) grow();
        Ends& slot = slots_[slot_of(ends)];
        if (slot == ends) return false;
        slot = ends;
        ++count_;
        return true;
    }

private:
    static constexpr Ends empty{-1, -1};

    std::size_t slot_of(Ends ends) const {
        const std::uint64_t key = std::uint64_t(ends.first) << 32 | std::uint32_t(ends.second);
        // 2⁶⁴ divided by the golden ratio: spreads neighbouring keys
        constexpr std::uint64_t golden = 0x9e3779b97f4a7c15;
        std::size_t at = std::size_t((key * golden) >> 32) & (slots_.size() - 1);
        while (slots_[at] != empty && slots_[at] != ends) at = (at + 1) & (slots_.size() - 1);
        return at;
    }
    void grow() {
        std::vector<Ends> old(std::max<std::size_t>(64, 2 * slots_.size()), empty);
        old.swap(slots_);
        for (const Ends& ends : old)
            if (ends != empty) slots_[slot_of(ends)] = ends;
    }

    std::vector<Ends> slots_;  // their number is a power of two
    std::size_t count_ = 0;
};

/// One extraction of a mesh.
class Extraction : BoundaryPolygons {
public:
    Extraction(const Subspace& subspace, const SolidTree& solid) : BoundaryPolygons(subspace, solid) {}

    Mesh run(std::vector<Origin>* origins) {
        join_flat();
        trace();
        straighten();
        separate_double_edges();
        return build(origins);
    }

private:
    /// Whether all corners of p lie in the plane of the other polygon.
    bool in_plane(const Polygon& p, const Polygon& plane) const {
        for (int h = p.first; h < p.first + p.count; ++h)
            if (std::abs(glm::dot(plane.normal, positions_[vertex_[h]]) - plane.offset) > flat_slack()) return false;
        return true;
    }
    double flat_slack() const { return 0.1 * complex_.tolerance; }

    /// Merges neighbouring flat polygons of one plane, leaf and material into groups.
    void join_flat() {
        group_ = UnionFind(polygons_.size());
        for (std::size_t h = 0; h < steps_.size(); ++h) {
            const int a = group_.find(owner_[h]), b = group_.find(owner_[twin_[h]]);
            if (a == b) continue;
            const Polygon &p = polygons_[a], &q = polygons_[b];
            if (p.leaf != q.leaf || p.material != q.material || p.normal == Vec3(0.0)) continue;
            if (glm::dot(p.normal, q.normal) < 1 - 1e-9) continue;
            const Polygon& other = polygons_[owner_[twin_[h]]];
            if (!in_plane(p, p) || !in_plane(q, p) || !in_plane(other, p)) continue;
            group_.join(a, b);
        }
    }

    /// Whether the half-edge is between two groups.
    bool is_border(int h) { return group_.find(owner_[h]) != group_.find(owner_[twin_[h]]); }

    // Links every half-edge between groups with the next one around its group.
    void trace() {
        next_.assign(steps_.size(), -1);
        before_.assign(steps_.size(), -1);
        for (std::size_t h = 0; h < steps_.size(); ++h) {
            if (!is_border(int(h))) continue;
            int n = next(int(h));
            while (!is_border(n)) n = next(twin_[n]);
            next_[h] = n;
            before_[n] = int(h);
        }
    }

    static std::pair<int, int> ends(int a, int b) { return std::minmax(a, b); }
    int head(int h) const { return vertex_[next_[h]]; }

    // Whether a half-edge between groups leads to `vertex` from the vertex where h starts.
    bool is_joined(int h, int vertex) const {
        int at = h;
        do {
            if (head(at) == vertex) return true;
            at = next_[twin_[at]];
        } while (at != h);
        return false;
    }

    // Removes vertices on a straight line between two groups.
    void straighten() {
        std::vector<int> degree(positions_.size(), 0);
        for (std::size_t h = 0; h < steps_.size(); ++h)
            if (next_[h] >= 0) ++degree[vertex_[h]];
        for (std::size_t h = 0; h < steps_.size(); ++h) {
            // h runs from a to v and n from v to b; their twins run back.
            if (next_[h] < 0) continue;
            while (true) {
                const int n = next_[h], v = vertex_[n];
                const int a = vertex_[h], b = head(n);
                const int hb = twin_[h], nb = twin_[n];
                if (degree[v] != 2 || a == b || next_[nb] != hb) break;
                if (next_[next_[n]] == int(h)) break;  // a triangle keeps its corners
                if (next_[next_[hb]] == nb) break;
                const Vec3 line = positions_[b] - positions_[a];
                const Vec3 x = positions_[v] - positions_[a];
                const double along = glm::dot(x, line), length2 = glm::dot(line, line);
                if (along <= 0 || along >= length2) break;
                if (glm::length(x - line * (along / length2)) > flat_slack()) break;
                if (is_joined(int(h), b)) break;
                // h and nb are kept and become twins: h from a to b, nb from b to a.
                next_[h] = next_[n];
                before_[next_[h]] = int(h);
                next_[nb] = next_[hb];
                before_[next_[nb]] = nb;
                next_[n] = next_[hb] = -1;
                twin_[h] = nb;
                twin_[nb] = int(h);
                degree[v] = 0;
            }
        }
    }

    // If several edges join the same two vertices, all but the first get a vertex in the middle.
    void separate_double_edges() {
        std::vector<int> doubles;
        for (std::size_t h = 0; h < steps_.size(); ++h) {
            if (next_[h] < 0 || int(h) > twin_[h]) continue;
            if (!borders_.add(ends(vertex_[h], head(int(h))))) doubles.push_back(int(h));
        }
        for (const int h : doubles) {
            const int t = twin_[h], middle = int(positions_.size());
            positions_.push_back(middle_of(vertex_[h], head(h), owner_[h], owner_[t]));
            const int second = insert_after(h, middle), back = insert_after(t, middle);
            twin_[h] = back;
            twin_[back] = h;
            twin_[t] = second;
            twin_[second] = t;
            borders_.add(ends(vertex_[h], middle));
            borders_.add(ends(vertex_[t], middle));
        }
    }

    // The middle of two vertices, moved to the surface of one of their polygons if that is curved.
    Vec3 middle_of(int a, int b, int p, int q) const {
        Vec3 x = 0.5 * (positions_[a] + positions_[b]);
        const Polygon& polygon = polygons_[polygons_[p].leaf >= 0 ? p : q];
        const LocalDensity* density = density_of(polygon);
        if (!density) return x;
        constexpr int steps = 20;  // Newton steps; 4 are enough where the surface is near
        const Vec3 start = x;
        const double reach = glm::length(positions_[a] - positions_[b]);
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
        const OpenLeaf* open = subspace_.open(p.inner, p.leaf);
        if (!open) open = subspace_.open(p.outer, p.leaf);
        return open ? open->density.get() : nullptr;
    }

    int insert_after(int h, int vertex) {
        const int fresh = int(steps_.size());
        steps_.push_back(steps_[h]);
        owner_.push_back(owner_[h]);
        vertex_.push_back(vertex);
        twin_.push_back(-1);
        next_.push_back(next_[h]);
        before_.push_back(h);
        before_[next_[h]] = fresh;
        next_[h] = fresh;
        return fresh;
    }

    // A diagonal between two vertices that are joined already gets a vertex in the middle.
    void separate_double_diagonals(std::vector<std::array<int, 3>>& triangles) {
        if (triangles.size() < 2) return;
        auto& uses = uses_;
        uses.clear();
        for (const auto& t : triangles)
            for (std::size_t k = 0; k < 3; ++k) uses.push_back({ends(t[k], t[(k + 1) % 3]), 1});
        std::sort(uses.begin(), uses.end());
        std::size_t kept = 0;
        for (std::size_t k = 0; k < uses.size(); ++k)
            if (kept > 0 && uses[kept - 1].first == uses[k].first)
                ++uses[kept - 1].second;
            else
                uses[kept++] = uses[k];
        uses.resize(kept);
        for (std::size_t i = 0; i < triangles.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                const int a = triangles[i][k], b = triangles[i][(k + 1) % 3], c = triangles[i][(k + 2) % 3];
                const auto key = ends(a, b);
                const auto use = std::lower_bound(uses.begin(), uses.end(), std::pair{key, 0});
                if (use == uses.end() || use->first != key || use->second < 2) continue;  // an edge of the border
                if (use->second == 2 && !borders_.has(key) && !diagonals_.has(key)) continue;
                // The other triangle at this diagonal runs along it in the opposite direction.
                for (std::size_t j = i + 1; j < triangles.size(); ++j) {
                    auto& t = triangles[j];
                    std::size_t m = 0;
                    while (m < 3 && !(t[m] == b && t[(m + 1) % 3] == a)) ++m;
                    if (m == 3) continue;
                    const int d = t[(m + 2) % 3], middle = int(positions_.size());
                    positions_.push_back(middle_of(a, b, corner(a).polygon, corner(b).polygon));
                    set_corner(middle, corner(a).polygon);
                    t = {b, middle, d};
                    triangles[i] = {a, middle, c};
                    triangles.push_back({middle, b, c});
                    triangles.push_back({middle, a, d});
                    use->second -= 2;
                    break;
                }
            }
        for (const auto& [key, count] : uses)
            if (count >= 2) diagonals_.add(key);
    }

    // A vertex of the group that is being built.
    struct Corner {
        int group = -1;
        int polygon = -1;  // a polygon that has it as a corner
        int normal = -1;   // number in the mesh
    };
    const Corner& corner(int v) const { return corners_[v]; }
    void set_corner(int v, int polygon) {
        if (std::size_t(v) >= corners_.size()) corners_.resize(positions_.size());
        if (corners_[v].group != building_) corners_[v] = {building_, polygon, -1};
    }

    // A vertex of the mesh. Its normals are a linked list.
    struct MeshVertex {
        int number = -1, first_normal = -1;
        // The latest normal, and the density that it came from.
        const LocalDensity* density = nullptr;
        bool subtracted = false;
        int normal = -1;
    };

    int corner_normal(int v, Mesh& mesh) {
        Corner& c = corners_[v];
        if (c.normal >= 0) return c.normal;
        const Polygon& p = polygons_[c.polygon];
        if (p.leaf < 0) return c.normal = normal_number(v, p.normal, mesh);
        MeshVertex& at = mesh_vertices_[v];
        const LocalDensity* density = density_of(p);
        const bool subtracted = subspace_.side(p.inner, p.leaf) == Side::outside;
        if (density && density == at.density && subtracted == at.subtracted) return c.normal = at.normal;
        const Vec3 g = density ? density->gradient_at(positions_[v]).gradient : Vec3(0.0);
        const double length = glm::length(g);
        if (!(length > 1e-12)) return c.normal = normal_number(v, p.normal, mesh);
        // The gradient points into the leaf, which is out of the solid where the leaf is subtracted.
        c.normal = normal_number(v, g * ((subtracted ? 1.0 : -1.0) / length), mesh);
        at.density = density;
        at.subtracted = subtracted;
        return at.normal = c.normal;
    }

    int normal_number(int v, Vec3 n, Mesh& mesh) {
        constexpr double same_normal = 1e-6;
        int* known = &mesh_vertices_[v].first_normal;
        for (; *known >= 0; known = &next_normal_[*known])
            if (glm::length(mesh.normals[*known] - n) < same_normal) return *known;
        const int fresh = *known = int(mesh.normals.size());
        mesh.normals.push_back(n);
        next_normal_.push_back(-1);
        return fresh;
    }

    Mesh build(std::vector<Origin>* origins) {
        std::vector<std::pair<int, int>> rings;  // group and a half-edge
        std::vector<char> done(steps_.size(), false);
        for (std::size_t h = 0; h < steps_.size(); ++h) {
            if (next_[h] < 0 || done[h]) continue;
            rings.push_back({group_.find(owner_[h]), int(h)});
            for (int at = int(h); !done[at]; at = next_[at]) done[at] = true;
        }
        std::sort(rings.begin(), rings.end());
        Mesh mesh;
        // A polygon of n corners becomes n − 2 triangles.
        const auto corners = std::size_t(std::ranges::count_if(next_, [](int n) { return n >= 0; }));
        const std::size_t triangles_expected = corners - std::min(corners, 2 * rings.size());
        mesh.triangles.reserve(triangles_expected);
        if (origins) origins->reserve(triangles_expected);
        mesh.positions.reserve(positions_.size());
        std::vector<std::vector<int>> loops, spare;
        for (auto ring = rings.begin(); ring != rings.end();) {
            building_ = ring->first;
            const Polygon& plane = polygons_[building_];
            while (!loops.empty()) {
                spare.push_back(std::move(loops.back()));
                loops.pop_back();
            }
            for (; ring != rings.end() && ring->first == building_; ++ring) {
                if (spare.empty()) spare.emplace_back();
                loops.push_back(std::move(spare.back()));
                spare.pop_back();
                loops.back().clear();
                int h = ring->second;
                do {
                    loops.back().push_back(vertex_[h]);
                    set_corner(vertex_[h], owner_[h]);
                    h = next_[h];
                } while (h != ring->second);
            }
            ++mesh.polygons;
            std::vector<std::array<int, 3>> triangles = triangles_of(loops, positions_, plane.normal);
            separate_double_diagonals(triangles);
            mesh_vertices_.resize(positions_.size());
            for (const auto& t : triangles) {
                Triangle triangle{};
                triangle.material = plane.material;
                for (std::size_t k = 0; k < 3; ++k) {
                    int& v = mesh_vertices_[t[k]].number;
                    if (v < 0) {
                        v = int(mesh.positions.size());
                        mesh.positions.push_back(positions_[t[k]]);
                    }
                    triangle.vertex[k] = v;
                    triangle.normal[k] = corner_normal(t[k], mesh);
                }
                mesh.triangles.push_back(triangle);
                if (origins)
                    origins->push_back(plane.leaf < 0 ? Origin{-1, plane.leaf}
                                                      : Origin{subspace_.origin(plane.inner), plane.leaf});
            }
        }
        return mesh;
    }

    UnionFind group_;                                        // of polygons
    std::vector<int> next_, before_;                         // around a group; −1: within it
    EdgeSet borders_, diagonals_;                            // edges of polygons; diagonals within them
    int building_ = -1;                                      // the group that is being built
    std::vector<std::pair<std::pair<int, int>, int>> uses_;  // edges of its triangles with numbers of uses
    std::vector<Corner> corners_;
    std::vector<MeshVertex> mesh_vertices_;
    std::vector<int> next_normal_;  // the next normal at the same vertex
};

}  // namespace

Mesh surface(const Subspace& subspace, const SolidTree& solid, std::vector<Origin>* origins) {
    return Extraction(subspace, solid).run(origins);
}

}  // namespace deburr
