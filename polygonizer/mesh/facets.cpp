#include "polygonizer/mesh/facets.hpp"

#include <algorithm>

#include "polygonizer/mesh/patches.hpp"

namespace deburr {
Facets::Facets(Mesh& mesh, std::vector<Origin>& origins, Patches* patches)
    : mesh_(mesh), origins_(origins), patches_(patches) {
    around_.resize(mesh.positions.size());
    facets_.reserve(mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        facets_.push_back({mesh.triangles[t], origins[t]});
        for (const int v : mesh.triangles[t].vertex) around_[v].push_back(int(t));
    }
    alive_.assign(facets_.size(), true);
}

int Facets::across(int a, int b) const {
    for (const int f : around(a)) {
        const auto& v = at(f).triangle.vertex;
        for (std::size_t k = 0; k < 3; ++k)
            if (v[k] == b && v[(k + 1) % 3] == a) return f;
    }
    return -1;
}

bool Facets::joined(int a, int b) const {
    for (const int f : around(a))
        for (const int v : at(f).triangle.vertex)
            if (v == b) return true;
    return false;
}

int Facets::corner_index(int f, int vertex) const {
    const auto& v = at(f).triangle.vertex;
    return v[0] == vertex ? 0 : v[1] == vertex ? 1 : 2;
}

bool Facets::same_surface(const Facet& f, const Facet& g) const {
    if (f.origin.leaf != g.origin.leaf || f.triangle.material != g.triangle.material ||
        f.triangle.solid != g.triangle.solid)
        return false;
    return f.origin.leaf >= 0 || glm::length(normal(f.triangle.normal[0]) - normal(g.triangle.normal[0])) < same_normal;
}

bool Facets::no_surface(const Facet& f) const { return f.origin.leaf < 0 && normal(f.triangle.normal[0]) == Vec3(0.0); }

std::optional<Change> Facets::flip(int f, std::size_t k, bool give) const {
    const Facet& old = at(f);
    const Triangle& t = old.triangle;
    const int a = t.vertex[k], b = t.vertex[(k + 1) % 3], c = t.vertex[(k + 2) % 3];
    const int other = across(a, b);
    if (other < 0 || other == f) return {};
    const bool same = same_surface(old, at(other)), empty = no_surface(old) || (give && !same);
    if (!empty && !same) return {};
    const Triangle& beyond = at(other).triangle;
    std::size_t j = 0;
    while (beyond.vertex[j] != b) ++j;  // beyond runs b, a, d
    const int d = beyond.vertex[(j + 2) % 3];
    if (c == d || joined(c, d)) return {};
    const int nd = beyond.normal[(j + 2) % 3];
    int na = t.normal[k], nb = t.normal[(k + 1) % 3], nc = t.normal[(k + 2) % 3];
    if (empty) {
        nb = beyond.normal[j];
        na = beyond.normal[(j + 1) % 3];
        nc = at(other).origin.leaf < 0 ? nd : nearest_normal(c, at(other));
    }
    const Facet& kind = empty ? at(other) : old;
    Change change{{f, other}, {kind, kind}};
    change.in[0].triangle.vertex = {a, d, c};
    change.in[0].triangle.normal = {na, nd, nc};
    change.in[1].triangle.vertex = {d, b, c};
    change.in[1].triangle.normal = {nd, nb, nc};
    return change;
}

std::optional<Change> Facets::collapse(int u, int v) const {
    // Link condition: u and v have exactly the two opposite vertices as common neighbours.
    const Fan nu = neighbours(u), nv = neighbours(v);
    const auto common =
        std::count_if(nu.begin(), nu.end(), [&](int w) { return std::find(nv.begin(), nv.end(), w) != nv.end(); });
    if (common != 2 || (nu.size() == 3 && nv.size() == 3)) return {};
    Change change;
    change.out.reserve(around(u).size());
    change.in.reserve(around(u).size());
    for (const int f : around(u)) {
        change.out.push_back(f);
        Facet moved = at(f);
        auto& vertex = moved.triangle.vertex;
        if (std::find(vertex.begin(), vertex.end(), v) != vertex.end()) continue;
        const std::size_t k = std::size_t(corner_index(f, u));
        vertex[k] = v;
        // A facet of a plane keeps its own normal.
        if (moved.origin.leaf >= 0) moved.triangle.normal[k] = nearest_normal(v, moved);
        change.in.push_back(moved);
    }
    if (change.out.size() != change.in.size() + 2) return {};
    return change;
}

Change Facets::split(int f, std::size_t k, int vertex, int normal, int normal_beyond) const {
    const Facet& old = at(f);
    const int a = old.triangle.vertex[k], b = old.triangle.vertex[(k + 1) % 3];
    const int other = across(a, b);
    Change change{{f, other}, {}};
    const auto halve = [&](const Facet& whole, int from, int to, int n) {
        for (const int end : {from, to}) {
            Facet half = whole;
            for (std::size_t i = 0; i < 3; ++i)
                if (whole.triangle.vertex[i] == end) half.triangle.vertex[i] = vertex, half.triangle.normal[i] = n;
            change.in.push_back(half);
        }
    };
    halve(old, a, b, normal);
    halve(at(other), b, a, normal_beyond);
    return change;
}

Change Facets::star(int f, int vertex, int normal) const {
    Change change{{f}, {}};
    for (std::size_t k = 0; k < 3; ++k) {
        Facet third = at(f);
        third.triangle.vertex[k] = vertex;
        third.triangle.normal[k] = normal;
        change.in.push_back(third);
    }
    return change;
}

int Facets::add_vertex(Vec3 x) {
    mesh_.positions.push_back(x);
    around_.emplace_back();
    return int(mesh_.positions.size()) - 1;
}

int Facets::add_normal(Vec3 n) {
    mesh_.normals.push_back(n);
    return int(mesh_.normals.size()) - 1;
}

void Facets::move(int vertex, Vec3 x) {
    mesh_.positions[vertex] = x;
    if (patches_) patches_->join({around_[vertex].begin(), around_[vertex].end()});
}

std::vector<int> Facets::apply(const Change& change) {
    for (const int f : change.out) {
        alive_[f] = false;
        for (const int v : at(f).triangle.vertex) {
            auto& list = around_[v];
            const auto at = std::find(list.begin(), list.end(), f);
            list.erase(at, at + 1);
        }
    }
    std::vector<int> fresh;
    for (std::size_t k = 0; k < change.in.size(); ++k) {
        int f;
        if (k < change.out.size()) {
            f = change.out[k];
            facets_[f] = change.in[k];
            alive_[f] = true;
        } else {
            f = int(facets_.size());
            facets_.push_back(change.in[k]);
            alive_.push_back(true);
        }
        for (const int v : change.in[k].triangle.vertex) around_[v].push_back(f);
        fresh.push_back(f);
    }
    if (patches_) patches_->change(change, fresh);
    return fresh;
}

void Facets::finish(std::vector<int>* old_vertices, std::vector<int>* old_normals) {
    std::vector<int> position(mesh_.positions.size(), -1), normal(mesh_.normals.size(), -1);
    std::vector<Vec3> positions, normals;
    mesh_.triangles.clear();
    origins_.clear();
    const auto keep = [](int& index, std::vector<int>& new_index, std::vector<Vec3>& to,
                         const std::vector<Vec3>& from) {
        int& p = new_index[index];
        if (p < 0) {
            p = int(to.size());
            to.push_back(from[index]);
        }
        index = p;
    };
    for (std::size_t f = 0; f < facets_.size(); ++f) {
        if (!alive_[f]) continue;
        Triangle t = facets_[f].triangle;
        for (std::size_t k = 0; k < 3; ++k) {
            keep(t.vertex[k], position, positions, mesh_.positions);
            keep(t.normal[k], normal, normals, mesh_.normals);
        }
        mesh_.triangles.push_back(t);
        origins_.push_back(facets_[f].origin);
    }
    const auto say = [](std::vector<int>* old, const std::vector<int>& new_index, std::size_t count) {
        if (!old) return;
        old->resize(count);
        for (std::size_t k = 0; k < new_index.size(); ++k)
            if (new_index[k] >= 0) (*old)[new_index[k]] = int(k);
    };
    std::vector<int> own_vertices, own_normals;
    if (patches_ && !old_vertices) old_vertices = &own_vertices;
    if (patches_ && !old_normals) old_normals = &own_normals;
    say(old_vertices, position, positions.size());
    say(old_normals, normal, normals.size());
    if (patches_) {
        std::vector<int> left;
        for (std::size_t f = 0; f < facets_.size(); ++f)
            if (alive_[f]) left.push_back(int(f));
        patches_->renumber(left, *old_vertices, *old_normals);
    }
    mesh_.positions = std::move(positions);
    mesh_.normals = std::move(normals);
}

// The vertices that follow v in the facets around it, which are all of its neighbours.
Facets::Fan Facets::neighbours(int v) const {
    Fan out;
    for (const int f : around(v)) out.push_back(at(f).triangle.vertex[(corner_index(f, v) + 1) % 3]);
    return out;
}

// The normal at v that suits the facet best, if possible one of its own leaf.
int Facets::nearest_normal(int v, const Facet& f) const {
    Vec3 wanted(0.0);
    for (const int n : f.triangle.normal) wanted += normal(n);
    int best = -1;
    double best_dot = -infinity;
    for (const int other : around(v)) {
        const int n = at(other).triangle.normal[corner_index(other, v)];
        constexpr double own = 10;  // greater than any difference of two cosines
        const double d = glm::dot(normal(n), wanted) + (at(other).origin.leaf == f.origin.leaf ? own : 0);
        if (d > best_dot) {
            best_dot = d;
            best = n;
        }
    }
    return best;
}

}  // namespace deburr
