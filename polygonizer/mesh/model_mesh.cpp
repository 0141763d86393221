#include "polygonizer/mesh/model_mesh.hpp"

#include "bounds/union_find.hpp"

namespace deburr {

std::shared_ptr<const ClosedMesh> closed_mesh_of(const SolidTree& solid) {
    if (solid.nodes.size() != 1 || solid.nodes[0].op != SolidOp::leaf) return nullptr;
    const SolidLeaf& leaf = solid.leaves[solid.nodes[0].a];
    return leaf.field ? leaf.field->sharp_mesh() : nullptr;
}

Mesh mesh_of(const ClosedMesh& model, int material) {
    Mesh mesh;
    // Corners around a vertex that are connected share one vertex of the mesh: where the solid touches itself there are
    // two.
    UnionFind corners(3 * model.size());
    for (std::size_t t = 0; t < model.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const ClosedMesh::Neighbour& other = model.across(int(t), k);
            corners.join(3 * int(t) + k, 3 * other.triangle + (other.edge + 1) % 3);
            corners.join(3 * int(t) + (k + 1) % 3, 3 * other.triangle + other.edge);
        }
    std::vector<int> number(3 * model.size(), -1);
    mesh.normals.resize(model.planes());
    mesh.polygons = model.planes();
    for (std::size_t t = 0; t < model.size(); ++t) {
        const ClosedMesh::Plane& plane = model.plane(int(t));
        mesh.normals[plane.id] = plane.normal;
        Triangle triangle{{}, {plane.id, plane.id, plane.id}, material};
        for (std::size_t k = 0; k < 3; ++k) {
            int& n = number[corners.find(3 * int(t) + int(k))];
            if (n < 0) {
                n = int(mesh.positions.size());
                mesh.positions.push_back(model.vertices()[model.triangles()[t][k]]);
            }
            triangle.vertex[k] = n;
        }
        mesh.triangles.push_back(triangle);
    }
    return mesh;
}

}  // namespace deburr
