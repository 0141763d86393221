// A bounding volume hierarchy over the triangles of a mesh: which may meet, and how often the mesh winds around a
// point.
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "polygonizer/mesh/mesh.hpp"

namespace deburr {

/// Immutable, and safe to use from several threads while the mesh does not change.
class TriangleTree {
public:
    /// Keeps a reference to the mesh.
    explicit TriangleTree(const Mesh& mesh);

    /// Calls visit(t) for each triangle whose box meets the given one, until visit returns false; then visit() returns
    /// false, too.
    template <class Visit>
    bool visit(const Box& box, Visit visit, int node = 0) const {
        if (nodes_.empty() || intersection(nodes_[node].box, box).empty()) return true;
        const Node& n = nodes_[node];
        if (n.second >= 0) return this->visit(box, visit, node + 1) && this->visit(box, visit, n.second);
        for (int k = n.first; k < n.first + n.count; ++k) {
            const int t = order_[k];
            if (!intersection(boxes_[t], box).empty() && !visit(t)) return false;
        }
        return true;
    }

    /// How often the mesh, which must be closed, winds around x: 1 inside, 0 outside. None if x is on the surface, or
    /// so near an edge in all directions tried that it cannot be told.
    std::optional<int> winding(Vec3 x) const;

    /// The box of triangle t.
    const Box& box(int t) const { return boxes_[t]; }
    /// The box of all triangles; empty if there are none.
    Box box() const { return nodes_.empty() ? Box{} : nodes_[0].box; }

private:
    struct Node {
        Box box;
        int second = -1;           // second child; the first one follows the node; −1: a leaf
        int first = 0, count = 0;  // range in order_
    };
    void build(int first, int count);
    std::optional<int> winding(Vec3 x, Vec3 far) const;

    const Mesh& mesh_;
    std::vector<Box> boxes_;
    std::vector<int> order_;
    std::vector<Node> nodes_;
};

/// Whether the interiors of two triangles meet in more than a point or an edge that they share. It is exact for
/// slack = 0; otherwise triangles that reach into each other by no more than the length `slack` do not cross. Triangles
/// that touch do not cross; triangles that overlap in one plane do.
bool triangles_cross(const Mesh& mesh, const Triangle& s, const Triangle& t, double slack = 0);

}  // namespace deburr
