// A complex of cells that share vertices, edges and faces with their neighbours from the start [Triage §6.4 and §8 name
// such a honeycomb as the first thing missing].
//
// The complex changes only by three steps, each of which leaves a valid complex:
//   split_edge   puts a vertex on an edge; every face around the edge has it at once
//   split_face   puts a chain of edges across a face; the cells on both sides have both halves
//   split_cell   puts a disc of faces, bounded by a simple loop of edges, across a cell
// Planes cut cells by these steps, and so does the isosurface (subspace.hpp): a root is searched for once per edge, a
// segment is refined once per face, and when all cells are inside or outside, the faces between the two kinds are a
// closed surface, whatever rounding did to the coordinates.
//
// Robustness: a vertex nearer to a plane than `tolerance` counts as on it. Where that makes the signs of a cell's
// vertices contradict convexity, the cut is refused and nothing changes; the cell stays whole, and is left to the
// isosurface.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bounds/vec.hpp"
#include "polygonizer/mesh/chunked_list.hpp"
#include "polygonizer/mesh/short_list.hpp"

namespace deburr {

/// The plane n·x = offset.
struct Plane {
    Vec3 normal;    // unit
    double offset;  // n·x = offset
    double distance(Vec3 x) const { return glm::dot(normal, x) - offset; }
};

/// The complex. Callers may read the public lists, but change them only by the steps.
class CellComplex {
public:
    /// An edge with a direction: 2·edge, plus 1 if it runs from head to tail.
    using Step = int;
    template <std::uint32_t usual>
    using List = ShortList<int, usual>;
    using VertexList = List<6>;

    /// An edge between two vertices.
    struct Edge {
        int tail, head;
        List<6> faces;  // all faces at the edge, in no order
    };
    /// A face between two cells.
    struct Face {
        List<8> loop;     // steps, counter-clockwise seen from the front cell
        int back, front;  // cells on its two sides; `outside` (−1) beyond the initial box
    };
    static constexpr int outside = -1;

    /// A complex of one cell, number 0: the box.
    CellComplex(const Box& box, double tolerance);

    std::vector<Vec3> vertices;
    ChunkedList<Edge> edges;
    ChunkedList<Face> faces;
    ChunkedList<List<12>> cells;  // faces of each cell
    /// Vertices nearer to a plane than this count as on it.
    double tolerance;

    /// The vertices where a step starts and ends.
    int start(Step s) const { return (s & 1) ? edges[s >> 1].head : edges[s >> 1].tail; }
    int end(Step s) const { return (s & 1) ? edges[s >> 1].tail : edges[s >> 1].head; }
    /// The cell on the other side of one of the cell's faces; −1 (`outside`) beyond the initial box.
    int neighbour(int face, int cell) const { return faces[face].back == cell ? faces[face].front : faces[face].back; }
    /// The other face of the cell at one of its edges.
    int across(int edge, int face, int cell) const;
    /// The vertices of the cell, each once. The list is valid until the next call or change.
    const std::vector<int>& vertices_of(int cell) const;
    /// The vertices of the face, in the order of its loop.
    std::vector<int> corners(int face) const;
    /// A vector perpendicular to the face, towards the front cell, whose length is twice its area.
    Vec3 area_vector(int face) const;

    /// These cells and all that share an edge with one of them, in increasing order: what the cells' parts of a mesh
    /// depend on.
    std::vector<int> with_neighbours(std::span<const int> cells) const;
    /// These cells alone, which must be in increasing order, as a complex: its cell k is cells[k]. Faces that none of
    /// the other cells shares have `outside` beyond them.
    CellComplex part(std::span<const int> cells) const;

    /// Whether every loop is closed, every edge of a cell is in two of its faces, and every cell is a topological ball.
    /// For tests, as the steps keep it so.
    bool is_sound() const;

    /// Adds a vertex without edges and returns its number.
    int add_vertex(Vec3 x);
    /// Puts a vertex at x on the edge and returns it. The edge keeps its tail; its other half becomes the last edge.
    int split_edge(int edge, Vec3 x);
    /// Puts a chain of edges across the face from vertex a to vertex b, through new vertices at `between`. The face
    /// keeps what lies left of the chain. Returns the new face; the new edges are the last ones.
    int split_face(int face, int a, int b, std::span<const Vec3> between = {});
    /// Puts a disc of faces into the cell. They are given by their vertices, counter-clockwise seen from the side of
    /// `seed`, a face of the cell, on which the new cell will be. `loop` is the disc's border, made of edges of the
    /// cell. Returns the new cell; the new faces are the last ones.
    int split_cell(int cell, std::span<const Step> loop, int seed, std::span<const VertexList> disc);
    /// Cuts a convex cell by the plane. Returns the new cell, on the side to which the normal points, or −1 if the
    /// plane does not cut it or the cut was refused.
    int cut(int cell, const Plane& plane);

private:
    explicit CellComplex(double least_distance) : tolerance(least_distance) {}

    struct Join {  // joins two places of a cut, each an edge (~edge) or a vertex
        int from, to;
        bool used = false;
    };
    struct Reach {  // a face of the cell that is being cut
        int face;
        bool above, below;  // whether it has vertices there
    };
    std::vector<signed char> side_;  // of a vertex, during a cut: 1 above the plane, −1 below, 0 on it
    std::vector<Join> joins_;
    std::vector<Reach> reach_;
    mutable std::vector<int> list_;                // result of the last vertices_of()
    mutable std::array<std::size_t, 4> listed_{};  // the state that it is valid for: cell and numbers of elements
    mutable std::vector<std::uint32_t> seen_;
    mutable std::uint32_t stamp_ = 0;
    std::vector<std::uint32_t> rim_;  // by edge: when it was last on the border of a disc
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
