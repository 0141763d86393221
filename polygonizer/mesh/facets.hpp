// A closed mesh under change. Flips, collapses and splits are proposed first, so that what comes of
// them can be judged before anything happens; each leaves a closed 2-manifold behind.
#pragma once
#include <optional>
#include <vector>

#include "polygonizer/mesh/mesh.hpp"
#include "polygonizer/mesh/short_list.hpp"

namespace deburr {

/// Origin of a triangle: the cell of the subdivision that made it, and the leaf of the solid whose
/// isosurface it approximates. Both are −1 if it is part of a plane: its corners have one normal.
struct Origin {
    int cell = -1, leaf = -1;
    static constexpr int wall = -2;  // in place of a leaf: the triangle only closes the mesh of a part of a solid
};

struct Facet {
    Triangle triangle;
    Origin origin;
};

/// Facets that go, by number, and facets that come.
struct Change {
    std::vector<int> out;
    std::vector<Facet> in;
};

class Patches;

class Facets {
public:
    using Fan = ShortList<int, 8>;

    /// `origins`: one for each triangle. Both are brought up to date by finish().
    /// `patches` of the mesh, if any, follow what happens to it.
    Facets(Mesh& mesh, std::vector<Origin>& origins, Patches* patches = nullptr);

    std::size_t size() const { return facets_.size(); }
    bool alive(int f) const { return alive_[f]; }
    const Facet& at(int f) const { return facets_[f]; }
    const Fan& around(int vertex) const { return around_[vertex]; }
    Vec3 position(int v) const { return mesh_.positions[v]; }
    Vec3 normal(int n) const { return mesh_.normals[n]; }
    Vec3 area_vector(const Triangle& t) const { return mesh_.area_vector(t); }
    int vertices() const { return int(mesh_.positions.size()); }

    /// The facet that runs from b to a, or −1.
    int across(int a, int b) const;
    bool joined(int a, int b) const;
    int corner_index(int f, int vertex) const;  // of the vertex in the facet
    /// Whether both stand for one surface, as far as their edge from a to b can tell.
    bool same_surface(const Facet& f, const Facet& g) const;
    /// Whether the facet is part of a polygon without area, which may stand for any neighbour's surface.
    bool no_surface(const Facet& f) const;

    /// Edge k of facet f is replaced by the other diagonal of its two facets; none where that is no
    /// manifold, or where the edge parts two surfaces, unless f may be given to the surface beyond.
    std::optional<Change> flip(int f, std::size_t k, bool give = false) const;
    /// Vertex u moves onto its neighbour v; none where that is no manifold.
    std::optional<Change> collapse(int u, int v) const;
    /// Edge k of facet f gets a vertex, with the normals it has there in f and beyond.
    Change split(int f, std::size_t k, int vertex, int normal, int normal_beyond) const;

    /// Facet f gets a vertex in its middle.
    Change star(int f, int vertex, int normal) const;

    int add_vertex(Vec3 x);
    int add_normal(Vec3 n);
    void move(int vertex, Vec3 x);
    void set_normal(int n, Vec3 x) { mesh_.normals[n] = x; }
    /// Returns the numbers of the facets that came.
    std::vector<int> apply(const Change& change);
    /// Drops what is no longer used. Of what is left, `vertices` and `normals` get the numbers that it had.
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
