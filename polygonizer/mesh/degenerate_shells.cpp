#include "polygonizer/mesh/degenerate_shells.hpp"

#include <cmath>

#include "bounds/union_find.hpp"

namespace deburr {
namespace {

/// A connected component of the mesh's triangles.
struct Shell {
    double area = 0, volume = 0;
    std::size_t triangles = 0, wrong = 0;
    Vec3 normals{0.0};      // sum of the corners' normals
    bool one_sheet = true;  // all corner normals face the same way, as around no part of a solid
    /// Whether the shell is to be dropped.
    bool goes = false;

    // Whether the shell is thin: its volume divided by its area to the power 1.5 is less than that of a 50 × 50 × 1
    // plate.
    bool thin() const { return volume <= 0.01 * area * std::sqrt(area); }
};

class Shells {
public:
    explicit Shells(const Mesh& mesh) : joined_(mesh.positions.size()), shells_(mesh.positions.size()) {
        for (const Triangle& t : mesh.triangles)
            for (const std::size_t k : {1, 2}) joined_.join(t.vertex[0], t.vertex[k]);
        for (const Triangle& t : mesh.triangles) {
            const int of = joined_.find(t.vertex[0]);
            const Vec3 area = mesh.area_vector(t), from = mesh.positions[of];
            Shell& s = shells_[of];
            s.area += 0.5 * glm::length(area);
            s.volume += glm::dot(mesh.positions[t.vertex[0]] - from, area) / 6;
            for (const int n : t.normal) s.normals += mesh.normals[n];
            ++s.triangles;
        }
        for (const Triangle& t : mesh.triangles) {
            Shell& s = of(t);
            for (const int n : t.normal) s.one_sheet &= glm::dot(mesh.normals[n], s.normals) > 0;
        }
    }

    Shell& of(const Triangle& t) { return shells_[joined_.find(t.vertex[0])]; }
    /// Indexed by vertices; most entries have no triangles.
    std::vector<Shell>& all() { return shells_; }

private:
    UnionFind joined_;  // of vertices
    std::vector<Shell> shells_;
};

// Whether there is solid on either side of the triangle's middle, within a few distances of the surface.
bool holds_solid(const Mesh& mesh, const Triangle& t, const DistanceField& solid) {
    const Vec3 area = mesh.area_vector(t);
    const double size = glm::length(area);
    if (!(size > 0)) return false;
    Vec3 middle(0.0);
    for (const int v : t.vertex) middle += mesh.positions[v] / 3.0;
    // Steps grow from a fraction of the triangle's size to a few distances from the surface.
    constexpr double first_step = 1e-7, growth = 1.5, far = 4, widest = 0.1;
    const double side = std::sqrt(size), away = std::abs(solid.at(middle).distance);
    const double reach = std::min(widest * side, far * away + 2 * first_step * side);
    for (double step = first_step * side; step <= reach; step *= growth)
        if (solid.inside(middle - area * (step / size)) || solid.inside(middle + area * (step / size))) return true;
    return false;
}

// Drops the shells that go, renumbers `wrong`, and returns the number of triangles dropped.
std::size_t drop(Shells& shells, Mesh& mesh, std::vector<Origin>& origins, std::vector<int>& wrong) {
    std::vector<int> new_index;
    std::size_t kept = 0;
    const std::size_t before = mesh.triangles.size();
    for (std::size_t t = 0; t < before; ++t) {
        const bool goes = shells.of(mesh.triangles[t]).goes;
        new_index.push_back(goes ? -1 : int(kept));
        if (goes) continue;
        mesh.triangles[kept] = mesh.triangles[t];
        origins[kept++] = origins[t];
    }
    mesh.triangles.resize(kept);
    origins.resize(kept);
    for (int& t : wrong) t = new_index[t];
    std::erase(wrong, -1);
    return before - kept;
}

}  // namespace

std::size_t drop_flat_shells(Mesh& mesh, std::vector<Origin>& origins, double thickness, const DistanceField& solid) {
    Shells shells(mesh);
    bool any_thin = false, any = false;
    for (Shell& s : shells.all()) {
        any_thin |= s.triangles > 0 && s.thin();
        s.goes = s.thin();
    }
    if (!any_thin) return 0;
    // A thin shell that holds some of the solid shows it beside one of its triangles.
    for (const Triangle& t : mesh.triangles) {
        Shell& s = shells.of(t);
        if (s.goes && std::abs(s.volume) > thickness * s.area && holds_solid(mesh, t, solid)) s.goes = false;
    }
    for (const Shell& s : shells.all()) any |= s.triangles > 0 && s.goes;
    std::vector<int> none;
    return any ? drop(shells, mesh, origins, none) : 0;
}

std::size_t drop_wrong_shells(Mesh& mesh, std::vector<Origin>& origins, std::vector<int>& wrong) {
    if (wrong.empty()) return 0;
    Shells shells(mesh);
    for (const int t : wrong) ++shells.of(mesh.triangles[t]).wrong;
    for (Shell& s : shells.all()) s.goes = s.thin() && s.wrong > 0 && (s.one_sheet || 2 * s.wrong >= s.triangles);
    const std::size_t gone = drop(shells, mesh, origins, wrong);
    if (gone > 0) Facets(mesh, origins).finish();
    return gone;
}

}  // namespace deburr
