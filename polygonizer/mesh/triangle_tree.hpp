// A bounding volume hierarchy over the triangles of a mesh: which may meet, and how often the mesh winds around a
// point.
#pragma once
#include <array>
#include <optional>
#include <span>
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
    bool visit(const Box& box, Visit visit) const {
        return visit_nodes(box, 0, [&](const Node& n) {
            for (int k = n.first; k < n.first + n.count; ++k)
                if (!intersection(boxes_[order_[k]], box).empty() && !visit(order_[k])) return false;
            return true;
        });
    }

    /// The number of nodes.
    std::size_t nodes() const { return nodes_.size(); }
    /// Calls visit(s, t) for the pairs of different triangles whose boxes meet and that belong to this node. Over all
    /// nodes each pair comes once, with its two triangles in either order.
    template <class Visit>
    void visit_pairs(std::size_t node, Visit visit) const {
        const Node& own = nodes_[node];
        if (!is_leaf(own, int(node))) return;
        visit_nodes(own.box, int(node), [&](const Node& n) {
            for (int k = own.first; k < own.first + own.count; ++k)
                for (int l = &n == &own ? k + 1 : n.first; l < n.first + n.count; ++l)
                    if (!intersection(boxes_[order_[k]], boxes_[order_[l]]).empty()) visit(order_[k], order_[l]);
            return true;
        });
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
        int end = 0;               // the number after the last of the nodes below, which follow this one
        int first = 0, count = 0;  // range in order_
    };
    static bool is_leaf(const Node& node, int at) { return node.end == at + 1; }
    // Calls visit(leaf) for leaves whose boxes meet the given one, from node `first` on, until that returns false.
    template <class Visit>
    bool visit_nodes(const Box& box, int first, Visit visit) const {
        for (int at = 0; at < int(nodes_.size());) {
            const Node& n = nodes_[at];
            if (n.end <= first || intersection(n.box, box).empty()) {
                at = n.end;
                continue;
            }
            if (is_leaf(n, at) && !visit(n)) return false;
            ++at;
        }
        return true;
    }
    // A triangle while the tree is built.
    struct Item {
        Vec3 middle;  // twice the middle of its box
        int triangle;
    };
    void build(std::span<Item> items);
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
