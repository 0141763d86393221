#include "polygonizer/octree/point_mesh.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

namespace deburr {

std::vector<PointMesh::Edge> PointMesh::paired(std::vector<Directed> all) {
    std::sort(all.begin(), all.end(), [](const Directed& x, const Directed& y) {
        return std::tie(x.lo, x.hi, y.forward, x.triangle) < std::tie(y.lo, y.hi, x.forward, y.triangle);
    });
    std::vector<Edge> edges;
    for (std::size_t i = 0; i + 1 < all.size(); ++i) {
        const Directed &a = all[i], &b = all[i + 1];
        if (a.lo == b.lo && a.hi == b.hi && a.forward && !b.forward)
            edges.push_back({a.lo, a.hi, a.triangle, b.triangle});
    }
    return edges;
}

void PointMesh::divide(const Edge& e, SurfacePoint point) {
    const int v = int(points.size());
    points.push_back(std::move(point));
    for (const int side : {e.left, e.right}) {
        TriangleVertices &near = triangles[side], far = near;
        std::replace(near.begin(), near.end(), e.q, v);
        std::replace(far.begin(), far.end(), e.p, v);
        triangles.push_back(far);
    }
}

void PointMesh::divide(int triangle, SurfacePoint point) {
    const int v = int(points.size());
    points.push_back(std::move(point));
    const TriangleVertices t = triangles[triangle];
    triangles[triangle][2] = v;
    triangles.push_back({t[1], t[2], v});
    triangles.push_back({t[2], t[0], v});
}

Mesh PointMesh::mesh(std::vector<Origin>& origins) const {
    Mesh mesh;
    origins.clear();
    std::vector<int> first_normal;
    for (const SurfacePoint& p : points) {
        mesh.positions.push_back(p.position);
        first_normal.push_back(int(mesh.normals.size()));
        for (const Face& f : p.faces) mesh.normals.push_back(f.normal);
    }
    for (const TriangleVertices& t : triangles) {
        Triangle triangle{t, {}};
        int leaf = -1;
        const Vec3 area = area_vector(t);
        std::size_t min_faces = std::numeric_limits<std::size_t>::max();
        for (std::size_t k = 0; k < 3; ++k) {
            const auto& faces = point(t[k]).faces;
            std::size_t best = 0;
            for (std::size_t f = 1; f < faces.size(); ++f)
                if (glm::dot(area, faces[f].normal) > glm::dot(area, faces[best].normal)) best = f;
            triangle.normal[k] = first_normal[t[k]] + int(best);
            if (faces.size() < min_faces) {
                min_faces = faces.size();
                triangle.material = faces[best].material;
                leaf = faces[best].leaf;
            }
        }
        mesh.triangles.push_back(triangle);
        origins.push_back(leaf < 0 ? Origin{} : Origin{0, leaf});
    }
    mesh.polygons = polygons;
    return mesh;
}

}  // namespace deburr
