#include "polygonizer/repair.hpp"

#include <algorithm>

namespace deburr {
namespace {

// Below this cosine between a triangle and the surface at its middle it counts as leaning, and
// below this ratio of height to longest side as without area; what replaces it must do better.
constexpr double leaning = 0.1, better = 0.2;
constexpr double no_area = 1e-6;
constexpr double same_normal = 1e-6;

struct Shape {
    double cosine = 1;    // to the surface at its middle; −1 without area
    double distance = 0;  // of the middle from the surface
    bool good(double limit) const { return cosine >= limit; }
};

class Editing {
public:
    Editing(Mesh& mesh, const OffsetField& solid) : mesh_(mesh), solid_(solid) {
        around_.resize(mesh.positions.size());
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
            for (const int v : mesh.triangles[t].vertex) around_[std::size_t(v)].push_back(int(t));
        alive_.assign(mesh.triangles.size(), true);
    }

    const Triangle& triangle(int t) const { return mesh_.triangles[std::size_t(t)]; }
    Vec3 position(int v) const { return mesh_.positions[std::size_t(v)]; }
    const std::vector<int>& around(int v) const { return around_[std::size_t(v)]; }
    bool alive(int t) const { return alive_[std::size_t(t)]; }

    bool without_area(const Triangle& t) const {
        const double twice = glm::length(mesh_.area_vector(t));
        double longest = 0;
        for (std::size_t k = 0; k < 3; ++k)
            longest = std::max(longest, glm::length(position(t.vertex[k]) - position(t.vertex[(k + 1) % 3])));
        return twice <= no_area * longest * longest;
    }

    Shape shape(const Triangle& t) const {
        if (without_area(t)) return {-1, 0};
        const Vec3 area = mesh_.area_vector(t);
        Vec3 middle(0.0), normals(0.0);
        for (std::size_t k = 0; k < 3; ++k) {
            middle += position(t.vertex[k]) / 3.0;
            normals += mesh_.normals[std::size_t(t.normal[k])];
        }
        const Offset o = solid_.at(middle);
        const Vec3 normal = o.normal != Vec3(0.0) ? o.normal : glm::length(normals) > 0 ? glm::normalize(normals) : normals;
        return {glm::dot(area, normal) / glm::length(area),
                std::isfinite(o.distance) ? std::abs(o.distance) : 0};
    }

    // The normal of a triangle that has one throughout, or 0.
    Vec3 flat_normal(int t) const {
        const auto& n = triangle(t).normal;
        const Vec3 a = mesh_.normals[std::size_t(n[0])];
        for (const std::size_t k : {1, 2})
            if (glm::length(mesh_.normals[std::size_t(n[k])] - a) >= same_normal) return Vec3(0.0);
        return a;
    }

    // The triangle that runs from b to a, or −1.
    int across(int a, int b) const {
        for (const int t : around(a))
            for (std::size_t k = 0; k < 3; ++k)
                if (triangle(t).vertex[k] == b && triangle(t).vertex[(k + 1) % 3] == a) return t;
        return -1;
    }
    bool joined(int a, int b) const {
        for (const int t : around(a))
            for (const int v : triangle(t).vertex)
                if (v == b) return true;
        return false;
    }

    // Edge k of triangle t, from a to b, is replaced by the other diagonal.
    bool flip(int t, std::size_t k, double limit) {
        const Triangle old = triangle(t);
        const int a = old.vertex[k], b = old.vertex[(k + 1) % 3], c = old.vertex[(k + 2) % 3];
        const int other = across(a, b);
        if (other < 0 || other == t) return false;
        const Triangle beyond = triangle(other);
        std::size_t j = 0;
        while (beyond.vertex[j] != b) ++j;  // beyond runs b, a, d
        const int d = beyond.vertex[(j + 2) % 3];
        if (c == d || joined(c, d) || old.material != beyond.material || old.solid != beyond.solid) return false;
        const int na = old.normal[k], nb = old.normal[(k + 1) % 3], nc = old.normal[(k + 2) % 3];
        const int nd = beyond.normal[(j + 2) % 3];
        Triangle first = old, second = beyond;
        first.vertex = {a, d, c};
        first.normal = {na, nd, nc};
        second.vertex = {d, b, c};
        second.normal = {nd, nb, nc};
        const Shape f = shape(first), s = shape(second);
        if (!f.good(limit) || !s.good(limit)) return false;
        const double was = std::max(shape(old).distance, shape(beyond).distance);
        if (std::max(f.distance, s.distance) > std::max(2 * was, slack(a, b))) return false;
        mesh_.triangles[std::size_t(t)] = first;
        mesh_.triangles[std::size_t(other)] = second;
        drop(b, t);
        drop(a, other);
        around_[std::size_t(d)].push_back(t);
        around_[std::size_t(c)].push_back(other);
        return true;
    }

    // Vertex u moves onto its neighbour v. Accepts what `accept` says of old and new triangles.
    template <class Accept>
    bool collapse(int u, int v, Accept accept) {
        // Link condition: u and v have exactly the two opposite vertices in common.
        std::vector<int> nu, nv, common;
        neighbours(u, nu);
        neighbours(v, nv);
        std::set_intersection(nu.begin(), nu.end(), nv.begin(), nv.end(), std::back_inserter(common));
        if (common.size() != 2 || nu.size() < 4 || nv.size() < 4) return false;
        std::vector<std::pair<int, Triangle>> changed;
        std::vector<int> dying;
        double was = 0;
        for (const int t : around(u)) {
            Triangle moved = triangle(t);
            was = std::max(was, shape(moved).distance);
            if (std::find(moved.vertex.begin(), moved.vertex.end(), v) != moved.vertex.end()) {
                dying.push_back(t);
                continue;
            }
            for (std::size_t k = 0; k < 3; ++k)
                if (moved.vertex[k] == u) {
                    moved.vertex[k] = v;
                    moved.normal[k] = nearest_normal(v, moved);
                }
            changed.push_back({t, moved});
        }
        if (dying.size() != 2) return false;
        for (const auto& [t, moved] : changed)
            if (moved.material != triangle(dying[0]).material && !same_surface(v, moved)) return false;
        for (const auto& [t, moved] : changed)
            if (!accept(triangle(t), moved, was)) return false;
        for (const int t : dying) {
            alive_[std::size_t(t)] = false;
            for (const int w : triangle(t).vertex) drop(w, t);
        }
        for (const auto& [t, moved] : changed) {
            mesh_.triangles[std::size_t(t)] = moved;
            around_[std::size_t(v)].push_back(t);
        }
        around_[std::size_t(u)].clear();
        return true;
    }

    double slack(int a, int b) const { return 1e-3 * glm::length(position(a) - position(b)); }

    void finish() {
        std::vector<Triangle> triangles;
        for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
            if (alive_[t]) triangles.push_back(mesh_.triangles[t]);
        std::vector<int> position(mesh_.positions.size(), -1), normal(mesh_.normals.size(), -1);
        std::vector<Vec3> positions, normals;
        for (Triangle& t : triangles)
            for (std::size_t k = 0; k < 3; ++k) {
                const auto keep = [](int& index, std::vector<int>& place, std::vector<Vec3>& to, const std::vector<Vec3>& from) {
                    int& p = place[std::size_t(index)];
                    if (p < 0) {
                        p = int(to.size());
                        to.push_back(from[std::size_t(index)]);
                    }
                    index = p;
                };
                keep(t.vertex[k], position, positions, mesh_.positions);
                keep(t.normal[k], normal, normals, mesh_.normals);
            }
        mesh_.triangles = std::move(triangles);
        mesh_.positions = std::move(positions);
        mesh_.normals = std::move(normals);
    }

private:
    void drop(int v, int t) {
        auto& list = around_[std::size_t(v)];
        list.erase(std::find(list.begin(), list.end(), t));
    }
    void neighbours(int v, std::vector<int>& out) const {
        for (const int t : around(v))
            for (const int w : triangle(t).vertex)
                if (w != v) out.push_back(w);
        std::sort(out.begin(), out.end());
        out.erase(std::unique(out.begin(), out.end()), out.end());
    }
    bool same_surface(int v, const Triangle& t) const {
        for (const int other : around(v))
            if (triangle(other).material == t.material) return true;
        return false;
    }
    // Of the normals at v, the one that suits the triangle.
    int nearest_normal(int v, const Triangle& t) const {
        Vec3 wanted(0.0);
        for (const int n : t.normal) wanted += mesh_.normals[std::size_t(n)];
        int best = -1;
        double best_dot = -infinity;
        for (const int other : around(v))
            for (std::size_t k = 0; k < 3; ++k) {
                if (triangle(other).vertex[k] != v) continue;
                const double d = glm::dot(mesh_.normals[std::size_t(triangle(other).normal[k])], wanted);
                if (d > best_dot) {
                    best_dot = d;
                    best = triangle(other).normal[k];
                }
            }
        return best;
    }

    Mesh& mesh_;
    const OffsetField& solid_;
    std::vector<std::vector<int>> around_;
    std::vector<char> alive_;
};

bool mend(Editing& edit, int t, RepairStatistics& statistics) {
    const Triangle old = edit.triangle(t);
    std::array<std::size_t, 3> by_length{0, 1, 2};
    const auto length = [&](std::size_t k) {
        return glm::length(edit.position(old.vertex[k]) - edit.position(old.vertex[(k + 1) % 3]));
    };
    std::sort(by_length.begin(), by_length.end(), [&](auto a, auto b) { return length(a) > length(b); });
    const auto accept = [&](const Triangle& before, const Triangle& after, double was) {
        const Shape s = edit.shape(after);
        return (s.good(better) || (s.cosine > -1 && s.cosine >= edit.shape(before).cosine)) &&
               s.distance <= std::max(2 * was, 1e-3 * length(by_length[0]));
    };
    for (const std::size_t k : {by_length[2], by_length[1]})
        if (length(k) < 0.2 * length(by_length[0]))
            for (const bool back : {false, true}) {
                const int u = old.vertex[k], v = old.vertex[(k + 1) % 3];
                if (edit.collapse(back ? v : u, back ? u : v, accept)) {
                    ++statistics.collapses;
                    return true;
                }
            }
    for (const std::size_t k : by_length)
        if (edit.flip(t, k, better)) {
            ++statistics.flips;
            return true;
        }
    for (const std::size_t k : {by_length[2], by_length[1], by_length[0]})
        for (const bool back : {false, true}) {
            const int u = old.vertex[k], v = old.vertex[(k + 1) % 3];
            if (edit.collapse(back ? v : u, back ? u : v, accept)) {
                ++statistics.collapses;
                return true;
            }
        }
    return false;
}

}  // namespace

RepairStatistics repair(Mesh& mesh, const OffsetField& solid) {
    RepairStatistics statistics;
    std::vector<int> bad;
    Editing edit(mesh, solid);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        if (!edit.shape(mesh.triangles[t]).good(leaning)) bad.push_back(int(t));
    if (bad.empty()) return statistics;
    constexpr int most_rounds = 12;
    for (int round = 0; round < most_rounds && !bad.empty(); ++round) {
        bool changed = false;
        std::vector<int> next;
        for (const int t : bad) {
            if (!edit.alive(t) || edit.shape(edit.triangle(t)).good(leaning)) continue;
            if (mend(edit, t, statistics)) changed = true;
            if (edit.alive(t)) next.push_back(t);
        }
        bad = std::move(next);
        if (!changed) break;
    }
    for (const int t : bad) statistics.left += edit.alive(t) && !edit.shape(edit.triangle(t)).good(leaning);
    edit.finish();
    return statistics;
}

std::size_t thin_borders(Mesh& mesh, const OffsetField& solid) {
    Editing edit(mesh, solid);
    double worst = 0;
    for (const Triangle& t : mesh.triangles) worst = std::max(worst, edit.shape(t).distance);
    const auto accept = [&](const Triangle&, const Triangle& after, double) {
        constexpr double upright = 0.8;
        const Shape s = edit.shape(after);
        return s.good(upright) && s.distance <= worst;
    };
    std::size_t gone = 0;
    for (int v = 0; v < int(mesh.positions.size()); ++v) {
        // Triangles at v in a flat face have one normal throughout; the others do not.
        Vec3 plane(0.0);
        bool single = true, bent = false;
        for (const int t : edit.around(v)) {
            const Vec3 n = edit.flat_normal(t);
            bent |= n == Vec3(0.0);
            if (n == Vec3(0.0)) continue;
            single &= plane == Vec3(0.0) || glm::length(n - plane) < same_normal;
            plane = n;
        }
        if (plane == Vec3(0.0) || !bent || !single) continue;
        std::vector<int> rim;  // neighbours on the border of the flat fan
        for (const int t : edit.around(v)) {
            if (edit.flat_normal(t) == Vec3(0.0)) continue;
            const Triangle& f = edit.triangle(t);
            for (std::size_t k = 0; k < 3; ++k) {
                const int a = f.vertex[k], b = f.vertex[(k + 1) % 3];
                if ((a == v || b == v) && edit.flat_normal(edit.across(a, b)) == Vec3(0.0))
                    rim.push_back(a == v ? b : a);
            }
        }
        if (rim.size() != 2) continue;
        const Vec3 p = glm::normalize(edit.position(rim[0]) - edit.position(v));
        const Vec3 q = glm::normalize(edit.position(rim[1]) - edit.position(v));
        if (glm::length(p + q) > 1e-9) continue;
        for (const int to : rim)
            if (edit.collapse(v, to, accept)) {
                ++gone;
                break;
            }
    }
    edit.finish();
    return gone;
}

}  // namespace deburr
