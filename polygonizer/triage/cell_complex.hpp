// A honeycomb of cells: vertices, edges and faces are shared between neighbours from the start
// [Triage §6.4 and §8 name it as the first thing missing].
//
// The complex changes by three steps only, each of which leaves a complex behind:
//   split_edge   a vertex is put on an edge, and every face around the edge has it at once
//   split_face   a chain of edges across a face, and the cells on both sides have both halves
//   split_cell   a disc of faces across a cell, bounded by a simple loop of its edges
// A plane cuts a cell by these steps, and so does the isosurface (subspace.hpp): a root is searched
// once per edge, a segment is refined once per face, and when all cells are inside or outside, the
// faces between the two kinds are a closed surface, whatever rounding did to the coordinates.
//
// Robustness: a vertex nearer to a plane than `tolerance` counts as on it. Where that makes the
// signs of a cell's vertices contradict convexity, the cut is refused and nothing is changed;
// the cell then stays whole, and is left to the isosurface.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bounds/vec.hpp"
#include "polygonizer/mesh/chunked_list.hpp"
#include "polygonizer/mesh/short_list.hpp"

namespace deburr {

struct Plane {
    Vec3 normal;    // unit
    double offset;  // n·x = offset
    double distance(Vec3 x) const { return glm::dot(normal, x) - offset; }
};

class CellComplex {
public:
    /// An edge with a direction: 2·edge, +1 if it runs from head to tail.
    using Step = int;
    template <std::uint32_t usual>
    using List = ShortList<int, usual>;
    using VertexList = List<6>;

    struct Edge {
        int tail, head;
        List<6> faces;  // all around it, in no order
    };
    struct Face {
        List<8> loop;     // steps, counter-clockwise, seen from the front cell
        int back, front;  // cells; `outside` (−1) beyond the initial box
    };
    static constexpr int outside = -1;

    /// One cell, number 0: the box.
    CellComplex(const Box& box, double tolerance);

    std::vector<Vec3> vertices;
    ChunkedList<Edge> edges;
    ChunkedList<Face> faces;
    ChunkedList<List<12>> cells;  // faces of each
    double tolerance;

    int start(Step s) const { return (s & 1) ? edges[s >> 1].head : edges[s >> 1].tail; }
    int end(Step s) const { return (s & 1) ? edges[s >> 1].tail : edges[s >> 1].head; }
    int neighbour(int face, int cell) const { return faces[face].back == cell ? faces[face].front : faces[face].back; }
    /// The other face of `cell` at this edge.
    int across(int edge, int face, int cell) const;
    /// Each vertex of the cell once; until the next call, or change.
    const std::vector<int>& vertices_of(int cell) const;
    std::vector<int> corners(int face) const;
    /// Area vector of the face: twice its area, towards the front cell.
    Vec3 area_vector(int face) const;

    /// Cells that share an edge with one of these, and these, in rising order: what their parts of a mesh depend on.
    std::vector<int> with_neighbours(std::span<const int> cells) const;
    /// These cells alone, which come in rising order, as a complex: cell k of it is cells[k], and beyond its faces that
    /// no other of them has is `outside`.
    CellComplex part(std::span<const int> cells) const;

    /// Whether every loop is closed, every edge of a cell lies in two of its faces, and every cell is
    /// a ball. For tests: the steps keep it so.
    bool is_sound() const;

    int add_vertex(Vec3 x);
    /// The new vertex. The edge keeps its tail; its other half is the last edge.
    int split_edge(int edge, Vec3 x);
    /// Leads a chain of new vertices from a to b, two vertices of the face; it keeps what lies left
    /// of the chain. Returns the new face; the new edges are the last ones.
    int split_face(int face, int a, int b, std::span<const Vec3> between = {});
    /// Puts the disc into the cell: faces given by their corners, counter-clockwise seen from the
    /// side of `seed`, a face of the cell, where the new cell will be. `loop` is the disc's rim,
    /// edges of the cell. Returns the new cell; the new faces are the last ones.
    int split_cell(int cell, std::span<const Step> loop, int seed, std::span<const VertexList> disc);
    /// Cuts a convex cell; returns the new cell, on the side the normal points to, or -1 if the
    /// plane does not cut it or the cut was refused.
    int cut(int cell, const Plane& plane);

private:
    explicit CellComplex(double least_distance) : tolerance(least_distance) {}

    struct Join {  // of two places of a cut, an edge or a vertex each
        int from, to;
        bool used = false;
    };
    struct Reach {  // of a face of the cell that a plane is cutting
        int face;
        bool above, below;  // whether it has vertices there
    };
    std::vector<signed char> side_;  // of a vertex, while a plane is cutting
    std::vector<Join> joins_;
    std::vector<Reach> reach_;
    mutable std::vector<int> list_;                // what vertices_of was asked for last,
    mutable std::array<std::size_t, 4> listed_{};  // and when: the cell and how many there were of everything
    mutable std::vector<std::uint32_t> seen_;
    mutable std::uint32_t stamp_ = 0;
    std::vector<std::uint32_t> rim_;  // by edge: when it was last on the rim of a disc
    std::uint32_t rim_stamp_ = 0;

    bool classify(int cell, const Plane& plane);
    bool cut_is_simple(int cell);
    const Reach& reach_of(int face) const;
    void split_crossed_edges(const Plane& plane);
    int split_crossed_face(int face);
    int split_crossed_faces(int cell, List<8>& ring);
    void order(List<8>& ring) const;
    bool runs_with_upper_face(int cell, const List<8>& ring) const;
};

}  // namespace deburr
