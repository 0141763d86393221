// A closed mesh under change. Flips, collapses and splits are first proposed as Changes, so that their result can be
// judged before anything happens. Each of them leaves the mesh a closed 2-manifold.
#pragma once
#include <optional>
#include <vector>

#include "polygonizer/mesh/mesh.hpp"
#include "polygonizer/mesh/short_list.hpp"

namespace deburr {

/// Unit normals that differ by less than this are one.
constexpr double same_normal = 1e-6;

/// Where a triangle comes from: the cell of the subdivision that made it, and the leaf of the solid whose isosurface it
/// approximates. Both are −1 if the triangle is part of a plane; then its corners have one normal.
struct Origin {
    int cell = -1, leaf = -1;
    static constexpr int wall = -2;  // as a leaf: the triangle only closes the mesh of a part of a solid
};

/// A triangle and its origin.
struct Facet {
    Triangle triangle;
    Origin origin;
};

/// A proposed change: the numbers of facets that are removed, and the facets that replace them.
struct Change {
    std::vector<int> out;
    std::vector<Facet> in;
};

class Patches;

/// The facets of a mesh by number, and those around each vertex. New facets take the numbers of those that
/// they replace.
class Facets {
public:
    /// The facets around a vertex, in no order.
    using Fan = ShortList<int, 8>;

    /// Keeps references to the mesh and to `origins`, which has one for each triangle; finish() brings both up to date.
    /// If `patches` of the mesh are given, they follow every change.
    Facets(Mesh& mesh, std::vector<Origin>& origins, Patches* patches = nullptr);

    std::size_t size() const { return facets_.size(); }
    /// Whether facet f still exists.
    bool alive(int f) const { return alive_[f]; }
    const Facet& at(int f) const { return facets_[f]; }
    const Fan& around(int vertex) const { return around_[vertex]; }
    Vec3 position(int v) const { return mesh_.positions[v]; }
    Vec3 normal(int n) const { return mesh_.normals[n]; }
    Vec3 area_vector(const Triangle& t) const { return mesh_.area_vector(t); }
    int vertices() const { return int(mesh_.positions.size()); }

    /// The facet that runs from b to a; −1 if there is none.
    int across(int a, int b) const;
    /// Whether a facet has both vertices.
    bool joined(int a, int b) const;
    int corner_index(int f, int vertex) const;  // which corner of the facet the vertex is, 0 … 2
    /// Whether both facets stand for one surface, as far as their common edge tells.
    bool same_surface(const Facet& f, const Facet& g) const;
    /// Whether the facet is part of a polygon without area, so that it may stand for any neighbour's surface.
    bool no_surface(const Facet& f) const;

    /// Replaces edge k (from corner k to corner k + 1) of facet f by the other diagonal of its two facets. None where
    /// the mesh would not stay a manifold, or where the edge parts two surfaces, unless with `give` f is given to the
    /// surface beyond.
    std::optional<Change> flip(int f, std::size_t k, bool give = false) const;
    /// Moves vertex u onto its neighbour v; none where the mesh would not stay a manifold.
    std::optional<Change> collapse(int u, int v) const;
    /// Puts `vertex` on edge k of facet f, with the normals of these numbers in f and in the facet beyond.
    Change split(int f, std::size_t k, int vertex, int normal, int normal_beyond) const;

    /// Puts `vertex` into the middle of facet f.
    Change star(int f, int vertex, int normal) const;

    /// Adds a position or a normal to the mesh and returns its number.
    int add_vertex(Vec3 x);
    int add_normal(Vec3 n);
    /// Moves a vertex without changing its normals.
    void move(int vertex, Vec3 x);
    void set_normal(int n, Vec3 x) { mesh_.normals[n] = x; }
    /// Applies a proposed change of the present facets and returns the numbers of the new facets.
    std::vector<int> apply(const Change& change);
    /// Writes the facets back to the mesh and drops unused vertices and normals. `vertices` and `normals` get, for each
    /// one that is left, its old number. The object must not be used afterwards.
    void finish(std::vector<int>* vertices = nullptr, std::vector<int>* normals = nullptr);

private:
    Fan neighbours(int v) const;
    int nearest_normal(int v, const Facet& f) const;

    Mesh& mesh_;
    std::vector<Origin>& origins_;
    Patches* patches_;
    std::vector<Facet> facets_;
    std::vector<Fan> around_;
    std::vector<char> alive_;
};

}  // namespace deburr
