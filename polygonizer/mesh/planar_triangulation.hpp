// A triangulation of points in the plane that can be made to contain given segments: Delaunay except for these.
//
// Points are inserted one by one along a Hilbert curve, into a triangle that is large enough for all. Segments are
// inserted by flips of the edges that they cross [Sloan 1993]. All decisions about sides are exact, so triangles are
// counter-clockwise for any points; the choice of the better diagonal is subject to rounding.
#pragma once
#include <array>
#include <vector>

#include "bounds/vec.hpp"

namespace deburr {

/// The triangulation. It keeps its memory when it is started again.
class PlanarTriangulation {
public:
    /// Side k of a triangle runs from corner k to the next corner.
    struct Triangle {
        std::array<int, 3> vertex;     // counter-clockwise
        std::array<int, 3> neighbour;  // triangle across side k; −1: none
        std::array<int, 3> mark;       // of side k, the same on the neighbour's side; −1: the side may be flipped
    };
    /// A side of a triangle; triangle = −1: none.
    struct Side {
        int triangle = -1, k = 0;
    };
    /// How far connect() came on the way from one point to another.
    struct ConnectResult {
        enum class End { there, vertex, marked } end = End::there;
        int vertex = -1;  // the point up to which the way is now an edge; −1 if `marked`
        Side crossed;     // `marked`: the side that is in the way
    };

    /// Triangulates the points, no two of which may be equal. Points n, n + 1 and n + 2 are added: the corners of a
    /// triangle around all.
    void start(const std::vector<Vec2>& points);

    /// Makes the way from a towards b an edge, up to b or to the first point on it. Changes nothing if a marked side
    /// crosses it before that point.
    ConnectResult connect(int a, int b);
    /// The side that runs from a to b; its triangle is −1 if there is none.
    Side side(int a, int b) const;
    /// The mark of a side; −1: none.
    int mark(Side s) const { return at(s.triangle).mark[s.k]; }
    /// Marks a side, so that it is not flipped, or with −1 removes its mark.
    void set_mark(Side s, int mark);

    /// Flips sides that are not Delaunay and not marked, between triangles that are both `wanted`.
    void improve(const std::vector<char>& wanted);

    const std::vector<Triangle>& triangles() const { return triangles_; }
    Vec2 point(int v) const { return points_[v]; }
    int around(int v) const { return around_[v]; }  // a triangle at the point

    static std::size_t next(std::size_t k) { return k == 2 ? 0 : k + 1; }
    static std::size_t before(std::size_t k) { return k == 0 ? 2 : k - 1; }

private:
    const Triangle& at(int t) const { return triangles_[t]; }
    Triangle& at(int t) { return triangles_[t]; }
    double orient(int a, int b, int c) const;
    std::size_t corner_index(int t, int vertex) const;
    int apex(Side s) const { return at(s.triangle).vertex[before(std::size_t(s.k))]; }
    Side twin(Side s) const;
    void set_side(int t, std::size_t k, int neighbour, int mark);
    void put(int t, std::array<int, 3> vertex);

    int locate(Vec2 x, int start) const;
    void insert(int v);
    void split_triangle(int t, int v);
    void split_side(Side s, int v);
    void legalize();
    bool may_flip(Side s) const;
    bool improves(Side s) const;
    void flip(Side s);

    std::vector<Vec2> points_;
    std::vector<Triangle> triangles_;
    std::vector<int> around_;
    std::vector<Side> todo_;
    std::vector<std::pair<std::uint64_t, int>> order_;
    std::vector<std::pair<int, int>> crossed_;
    int last_ = 0;
};

}  // namespace deburr
