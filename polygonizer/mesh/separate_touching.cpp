#include "polygonizer/mesh/separate_touching.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "polygonizer/mesh/facets.hpp"

namespace deburr {
namespace {

using Key = std::array<float, 3>;

Key key_of(Vec3 x) { return {float(x.x) + 0.0f, float(x.y) + 0.0f, float(x.z) + 0.0f}; }  // −0 is 0

// Vertices in use that have the same position in single precision as another.
std::vector<int> shared(const Mesh& mesh, const std::vector<char>& used) {
    std::vector<std::pair<Key, int>> keys;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        if (used[v]) keys.push_back({key_of(mesh.positions[v]), int(v)});
    std::sort(keys.begin(), keys.end());
    std::vector<int> found;
    for (std::size_t k = 0; k < keys.size(); ++k)
        if ((k > 0 && keys[k - 1].first == keys[k].first) ||
            (k + 1 < keys.size() && keys[k + 1].first == keys[k].first))
            found.push_back(keys[k].second);
    std::sort(found.begin(), found.end());
    return found;
}

/// The surroundings of a vertex.
struct Around {
    Vec3 inward{0.0};            // unit, or 0
    double shortest = infinity;  // length of its shortest edge
};

// The direction in which each of the vertices is to move, from the corners of its triangles.
std::vector<Around> surroundings(const Mesh& mesh, const std::vector<int>& vertices) {
    std::vector<int> new_index(mesh.positions.size(), -1);
    for (std::size_t k = 0; k < vertices.size(); ++k) new_index[vertices[k]] = int(k);
    std::vector<Around> around(vertices.size());
    std::vector<Vec3> middles(vertices.size(), Vec3(0.0));
    for (const Triangle& t : mesh.triangles) {
        const Vec3 area = mesh.area_vector(t);
        const double size = glm::length(area);
        for (std::size_t k = 0; k < 3; ++k) {
            const int at = new_index[t.vertex[k]];
            if (at < 0) continue;
            const Vec3 x = mesh.positions[t.vertex[k]];
            const Vec3 p = mesh.positions[t.vertex[(k + 1) % 3]] - x;
            const Vec3 q = mesh.positions[t.vertex[(k + 2) % 3]] - x;
            const double lp = glm::length(p), lq = glm::length(q);
            Around& a = around[at];
            for (const double l : {lp, lq})
                if (l > 0) a.shortest = std::min(a.shortest, l);
            if (!(size > 0) || !(lp > 0) || !(lq > 0)) continue;
            const double angle = std::atan2(size, glm::dot(p, q));
            a.inward -= area * (angle / size);
            middles[at] += p / lp + q / lq;
        }
    }
    for (std::size_t k = 0; k < around.size(); ++k) {
        constexpr double cancelled = 1e-6;
        Vec3& n = around[k].inward;
        if (glm::length(n) < cancelled) n = middles[k];
        n = glm::length(n) > cancelled ? glm::normalize(n) : Vec3(0.0);
    }
    return around;
}

// A distance that changes a position in single precision, in whatever direction it is moved.
double few_steps(const Mesh& mesh) {
    double largest = 0;
    for (const Vec3& x : mesh.positions)
        for (int k = 0; k < 3; ++k) largest = std::max(largest, std::abs(x[k]));
    constexpr double steps = 3;  // a step in any direction moves one coordinate by more than one
    return steps * largest * double(std::numeric_limits<float>::epsilon());
}

// Whether every new facet faces as its corners' normals do.
bool keeps_facing(const Facets& facets, const Change& change) {
    return std::all_of(change.in.begin(), change.in.end(), [&](const Facet& f) {
        const Vec3 area = facets.area_vector(f.triangle);
        return std::all_of(f.triangle.normal.begin(), f.triangle.normal.end(),
                           [&](int n) { return glm::dot(area, facets.normal(n)) > 0; });
    });
}

}  // namespace

double single_precision_step(const Mesh& mesh) { return std::max(min_separation, few_steps(mesh)); }

std::size_t merge_close(Mesh& mesh) {
    const auto coincide = [&](int u, int v) { return key_of(mesh.positions[u]) == key_of(mesh.positions[v]); };
    // Facets of the size of a few steps of single precision may face anywhere once they are rounded. Far from the
    // origin such steps are as large as the mesh's details, and a file of single precision is wrong in any case.
    constexpr double of_size = 1e-6;
    const Box box = bounding_box(mesh);
    const double least = std::min(few_steps(mesh), box.empty() ? 0 : of_size * largest(box.hi - box.lo));
    const auto are_near = [&](int u, int v) { return glm::distance(mesh.positions[u], mesh.positions[v]) < least; };
    std::vector<std::pair<int, int>> edges;
    for (const Triangle& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const int u = t.vertex[k], v = t.vertex[(k + 1) % 3];
            if (u < v && (are_near(u, v) || coincide(u, v))) edges.push_back({u, v});
        }
    if (edges.empty()) return 0;
    std::vector<Origin> origins(mesh.triangles.size());
    Facets facets(mesh, origins);
    std::size_t gone = 0;
    for (const auto& [u, v] : edges) {
        if (facets.around(u).empty() || facets.around(v).empty() || !facets.joined(u, v)) continue;
        const bool may_turn = coincide(u, v);
        auto change = facets.collapse(u, v);
        if (!change || !(may_turn || keeps_facing(facets, *change))) change = facets.collapse(v, u);
        if (!change || !(may_turn || keeps_facing(facets, *change))) continue;
        facets.apply(*change);
        ++gone;
    }
    facets.finish();
    return gone;
}

std::size_t separate_touching(Mesh& mesh, double step) {
    std::vector<char> used(mesh.positions.size(), false);
    for (const Triangle& t : mesh.triangles)
        for (const int v : t.vertex) used[v] = true;
    constexpr double max_edge_share = 0.1;
    std::vector<int> touching = shared(mesh, used);
    const std::vector<Around> around = surroundings(mesh, touching);
    const std::vector<Vec3> start = [&] {
        std::vector<Vec3> x;
        for (const int v : touching) x.push_back(mesh.positions[v]);
        return x;
    }();
    // Vertices whose parts lean in the same direction coincide again after a move; a second and a third round move them
    // by other amounts.
    constexpr double shares[] = {0.75, 1.0, 0.5};
    std::vector<int> left = touching;
    for (std::size_t round = 0; round < std::size(shares) && !left.empty(); ++round) {
        for (std::size_t k = 0; k < left.size(); ++k) {
            const std::size_t at =
                std::size_t(std::lower_bound(touching.begin(), touching.end(), left[k]) - touching.begin());
            if (at == touching.size() || touching[at] != left[k]) continue;  // it coincides with one that does not move
            // From the second round on, every other one of those that still coincide moves.
            if (round > 0 && k % 2 == 0) continue;
            const double length = std::min(step * shares[round], max_edge_share * around[at].shortest);
            mesh.positions[left[k]] = start[at] + around[at].inward * length;
        }
        left = shared(mesh, used);
    }
    return left.size();
}

}  // namespace deburr
