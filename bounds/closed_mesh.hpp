// A closed, oriented triangle mesh as the boundary of a solid, made ready for what looks at it near a point: plane of
// every triangle, its neighbours, and a bounding volume hierarchy.
//
// Triangles of one plane that hang together share a plane, so that a face is flat whatever its triangulation. Faces
// meet in pairs at every edge: where 2 k triangles share one, they are paired so that each pair bounds one wedge of
// the solid.
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
    std::size_t count;  // of edges that have not as many triangles on one side as on the other
    Vec3 place;         // middle of one of them
};

class ClosedMesh {
public:
    using Corners = std::array<int, 3>;

    /// One triangle's plane: n·x = offset, n unit and outward; `id` is equal for triangles of one plane that hang
    /// together.
    struct Plane {
        Vec3 normal{0.0};
        double offset = 0;
        int id = 0;
    };
    /// The triangle on the other side of an edge, and the number of that edge in it.
    struct Neighbour {
        int triangle = -1;
        int edge = 0;
    };
    struct Ball {
        Vec3 center{0.0};
        double radius = 0;
    };

    /// Corners run counter-clockwise seen from outside. Triangles whose corners lie on a line are dropped, and what
    /// they leave is closed by their neighbours. Throws NotClosed.
    ClosedMesh(std::vector<Vec3> vertices, std::vector<Corners> triangles);

    const std::vector<Vec3>& vertices() const { return vertices_; }
    const std::vector<Corners>& triangles() const { return triangles_; }
    std::size_t size() const { return triangles_.size(); }
    Vec3 corner(int triangle, int k) const { return vertices_[triangles_[triangle][k]]; }
    const Plane& plane(int triangle) const { return planes_[triangle]; }
    double area(int triangle) const { return areas_[triangle]; }
    double perimeter(int triangle) const { return perimeters_[triangle]; }
    /// Around the triangle.
    const Ball& ball(int triangle) const { return balls_[triangle]; }
    /// Across the edge from corner k to corner k + 1.
    const Neighbour& across(int triangle, int k) const { return neighbours_[triangle][k]; }
    /// A number of the edge that both its triangles know it by.
    int edge_id(int triangle, int k) const { return edges_[triangle][k]; }
    std::size_t planes() const { return plane_count_; }
    const Box& bounding_box() const { return box_; }
    /// Volume of the solid; negative if the mesh is inside out.
    double volume() const;

    /// Appends the triangles that may come within `reach` of the box, in rising order.
    void near(const Box& box, double reach, std::vector<int>& found) const;
    /// Calls visit(triangle) for the triangles that near() finds, in no order, until it returns false.
    template <class Visit>
    void visit_near(const Box& box, double reach, Visit visit) const;
    /// Upper bound of the number of triangles that near() finds, by the hierarchy's boxes alone.
    std::size_t count_near(const Box& box, double reach) const;
    /// Whether the triangle may come within `reach` of the box: never false where it does.
    bool reaches(int triangle, const Box& box, double reach) const;
    /// The point of the triangle that is nearest to x.
    Vec3 nearest(int triangle, Vec3 x) const;
    /// Whether x is inside; on the surface either is right. `triangles` are all that come within `reach` of x, or more:
    /// if one does, the nearest tells.
    bool contains(Vec3 x, std::span<const int> triangles, double reach) const;
    /// Whether x is inside.
    bool contains(Vec3 x) const;

private:
    struct Node {
        Box box;
        int begin = 0, end = 0;  // in order_; a leaf where left < 0
        int left = -1, right = -1;
    };
    struct Nearest {
        double square = infinity;
        int triangle = -1;
        int feature = 0;  // 0 … 2 corner, 3 … 5 edge from corner k − 3, 6 face
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
    std::vector<Vec3> vertex_normals_;  // weighted by angles, not unit
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

/// The mesh carried along by a regular map; one that mirrors turns its triangles, so that they face outward still.
ClosedMeshPtr transformed(const ClosedMesh& mesh, const Affine& map);

}  // namespace deburr
