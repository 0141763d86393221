#include "polygonizer/mesh/mesh.hpp"

#include <algorithm>

#include "bounds/union_find.hpp"

namespace deburr {
namespace {

struct DirectedEdge {
    int lo, hi;
    bool forward;  // runs from lo to hi
    int triangle;
    bool same_edge(const DirectedEdge& o) const { return lo == o.lo && hi == o.hi; }
};

}  // namespace

void Mesh::append(const Mesh& other, int solid) {
    const int p = int(positions.size()), n = int(normals.size());
    positions.insert(positions.end(), other.positions.begin(), other.positions.end());
    normals.insert(normals.end(), other.normals.begin(), other.normals.end());
    for (Triangle t : other.triangles) {
        for (int& v : t.vertex) v += p;
        for (int& v : t.normal) v += n;
        t.solid = solid;
        triangles.push_back(t);
    }
    polygons += other.polygons;
}

Topology topology(const Mesh& mesh) {
    Topology top;
    top.triangles = mesh.triangles.size();
    std::vector<DirectedEdge> edges;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const int a = mesh.triangles[t].vertex[k], b = mesh.triangles[t].vertex[(k + 1) % 3];
            edges.push_back({std::min(a, b), std::max(a, b), a < b, int(t)});
        }
    std::sort(edges.begin(), edges.end(), [](const DirectedEdge& x, const DirectedEdge& y) {
        return std::pair{x.lo, x.hi} < std::pair{y.lo, y.hi};
    });
    UnionFind shells(mesh.triangles.size()), corners(3 * mesh.triangles.size());
    const auto corner = [&](int t, int v) {
        const auto& vertex = mesh.triangles[t].vertex;
        return 3 * t + (vertex[0] == v ? 0 : vertex[1] == v ? 1 : 2);
    };
    for (std::size_t k = 0; k < edges.size();) {
        std::size_t end = k + 1;
        while (end < edges.size() && edges[end].same_edge(edges[k])) ++end;
        ++top.edges;
        if (end - k == 1) ++top.open_edges;
        if (end - k > 2) ++top.nonmanifold_edges;
        if (end - k == 2) {
            const DirectedEdge &a = edges[k], &b = edges[k + 1];
            if (a.forward == b.forward) ++top.flipped_edges;
            for (const int v : {a.lo, a.hi}) corners.join(corner(a.triangle, v), corner(b.triangle, v));
        }
        for (std::size_t j = k + 1; j < end; ++j) shells.join(edges[k].triangle, edges[j].triangle);
        k = end;
    }
    std::vector<int> fans(mesh.positions.size(), 0);
    for (std::size_t c = 0; c < corners.size(); ++c)
        if (corners.find(int(c)) == int(c)) ++fans[mesh.triangles[c / 3].vertex[c % 3]];
    for (const int n : fans) {
        top.vertices += n > 0;
        top.nonmanifold_vertices += n > 1;
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) top.shells += shells.find(int(t)) == int(t);
    top.euler = long(top.vertices) - long(top.edges) + long(top.triangles);
    return top;
}

Box bounding_box(const Mesh& mesh) {
    Box box;
    for (const Vec3& x : mesh.positions) box = hull(box, Box{x, x});
    return box;
}

Box bounding_box(const Mesh& mesh, const Triangle& triangle) {
    Box box;
    for (const int v : triangle.vertex) box = hull(box, Box{mesh.positions[v], mesh.positions[v]});
    return box;
}

double mean_edge(const Mesh& mesh) {
    double sum = 0;
    for (const Triangle& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k)  // every edge is counted in both of its triangles
            sum += glm::length(mesh.positions[t.vertex[k]] - mesh.positions[t.vertex[(k + 1) % 3]]);
    return mesh.triangles.empty() ? 0 : sum / (3 * double(mesh.triangles.size()));
}

Box field_box(const Mesh& mesh) {
    const Box box = bounding_box(mesh);
    return inflated(box, 1e-6 * (1 + glm::length(box.hi - box.lo)));
}

double volume(const Mesh& mesh) {
    if (mesh.positions.empty()) return 0;
    const Vec3 o = mesh.positions[0];
    double six = 0;
    for (const Triangle& t : mesh.triangles) six += glm::dot(mesh.positions[t.vertex[0]] - o, mesh.area_vector(t));
    return six / 6;
}

}  // namespace deburr
