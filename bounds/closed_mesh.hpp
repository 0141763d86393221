// A closed, oriented triangle mesh as the boundary of a solid, prepared for queries near a point: the plane and
// neighbours of every triangle, and a bounding volume hierarchy.
//
// Connected triangles that lie in one plane share a plane, so a face is flat whatever its triangulation. Triangles are
// neighbours in pairs: where 2k of them share an edge, they are paired so that each pair bounds one wedge of the solid.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <vector>

#include "bounds/vec.hpp"

namespace deburr {

/// Thrown for a mesh that is not the boundary of a solid.
struct NotClosed : std::invalid_argument {
    NotClosed(std::size_t count, Vec3 place);
    std::size_t count;  // number of edges with unequal numbers of triangles in the two directions
    Vec3 place;         // middle of one of these edges
};

/// Immutable after construction, and safe to use from several threads.
class ClosedMesh {
public:
    /// Vertex indices of a triangle.
    using Corners = std::array<int, 3>;

    /// The plane n·x = offset of a triangle, with n unit and outward. `id` is equal for connected triangles in one
    /// plane.
    struct Plane {
        Vec3 normal{0.0};
        double offset = 0;
        int id = 0;
    };
    /// The triangle on the other side of an edge, and the number of that edge in it (0 … 2).
    struct Neighbour {
        int triangle = -1;
        int edge = 0;
    };
    struct Ball {
        Vec3 center{0.0};
        double radius = 0;
    };

    /// Corners run counter-clockwise seen from outside. Triangles without area are dropped, and the gaps that they
    /// leave are closed by splitting their neighbours. Throws NotClosed if at some edge not as
    /// many triangles run one way as the other.
    ClosedMesh(std::vector<Vec3> vertices, std::vector<Corners> triangles);

    const std::vector<Vec3>& vertices() const { return vertices_; }
    const std::vector<Corners>& triangles() const { return triangles_; }
    std::size_t size() const { return triangles_.size(); }
    Vec3 corner(int triangle, int k) const { return vertices_[triangles_[triangle][k]]; }
    const Plane& plane(int triangle) const { return planes_[triangle]; }
    double area(int triangle) const { return areas_[triangle]; }
    double perimeter(int triangle) const { return perimeters_[triangle]; }
    /// A ball that holds the triangle.
    const Ball& ball(int triangle) const { return balls_[triangle]; }
    /// The neighbour across the edge from corner k to corner k + 1.
    const Neighbour& across(int triangle, int k) const { return neighbours_[triangle][k]; }
    /// A number of the edge that both of its triangles have for it.
    int edge_id(int triangle, int k) const { return edges_[triangle][k]; }
    /// The number of different planes: Plane::id is less than it.
    std::size_t planes() const { return plane_count_; }
    const Box& bounding_box() const { return box_; }
    /// Volume of the solid; negative if the mesh is inside out.
    double volume() const;

    /// Appends the triangles that may be within the distance `reach` of the box, in increasing order; none that is
    /// within it is left out.
    void near(const Box& box, double reach, std::vector<int>& found) const;
    /// Calls visit(triangle) for the triangles that near() would find, in any order, until visit returns false.
    template <class Visit>
    void visit_near(const Box& box, double reach, Visit visit) const;
    /// An upper bound of the number of triangles that near() would find, from the hierarchy's boxes alone.
    std::size_t count_near(const Box& box, double reach) const;
    /// Whether the triangle may be within the distance `reach` of the box; false only if it is not.
    bool reaches(int triangle, const Box& box, double reach) const;
    /// The point of the triangle nearest to x.
    Vec3 nearest(int triangle, Vec3 x) const;
    /// Whether x is inside; on the surface the answer may be either. `triangles` holds at least all that are within
    /// `reach` of x. If there are such triangles, the nearest decides; otherwise the whole mesh is searched.
    bool contains(Vec3 x, std::span<const int> triangles, double reach) const;
    /// Whether x is inside, from the whole mesh.
    bool contains(Vec3 x) const;

private:
    /// A node of the bounding volume hierarchy.
    struct Node {
        Box box;
        int begin = 0, end = 0;  // range in order_; a leaf has left < 0
        int left = -1, right = -1;
    };
    /// The nearest point of some triangles to a point.
    struct Nearest {
        double square = infinity;
        int triangle = -1;
        int feature = 0;  // on the triangle: 0 … 2 at a corner, 3 … 5 on the edge from corner k − 3, 6 inside
        Vec3 point{0.0};
    };
    void drop_degenerate();
    void find_planes();
    void find_neighbours();
    void join_planes();
    int build(int begin, int end);
    void look(Vec3 x, int triangle, Nearest& best) const;
    bool is_inside(Vec3 x, const Nearest& nearest) const;

    std::vector<Vec3> vertices_;
    std::vector<Corners> triangles_;
    std::vector<Plane> planes_;
    std::vector<double> areas_, perimeters_;
    std::vector<Ball> balls_;
    std::vector<std::array<Neighbour, 3>> neighbours_;
    std::vector<std::array<int, 3>> edges_;
    std::vector<Vec3> vertex_normals_;  // sums of adjacent normals weighted by their angles, not unit
    /// Triangles in the order of the hierarchy's leaves.
    std::vector<int> order_;
    std::vector<Node> nodes_;
    std::size_t plane_count_ = 0;
    Box box_;
};

template <class Visit>
void ClosedMesh::visit_near(const Box& box, double reach, Visit visit) const {
    if (nodes_.empty()) return;
    const Box wide = inflated(box, reach * (1 + 8 * epsilon));
    int stack[128], depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const Node& node = nodes_[stack[--depth]];
        if (intersection(node.box, wide).empty()) continue;
        if (node.left >= 0) {
            stack[depth++] = node.left;
            stack[depth++] = node.right;
            continue;
        }
        for (int i = node.begin; i < node.end; ++i)
            if (reaches(order_[i], box, reach) && !visit(order_[i])) return;
    }
}

using ClosedMeshPtr = std::shared_ptr<const ClosedMesh>;

/// The image of the mesh under a regular map. If the map mirrors, triangles are reversed so that they still face
/// outward.
ClosedMeshPtr transformed(const ClosedMesh& mesh, const Affine& map);

}  // namespace deburr
