// A triangulation of points in the plane that can be made to contain given segments: Delaunay but for these.
//
// Points are put in one by one along a Hilbert curve, into a triangle that is large enough for all; segments by
// flips of the edges that they cross [Sloan 1993]. Every decision about sides is exact, so that triangles are
// counter-clockwise always, whatever the points; which diagonal is the better one need not be.
#pragma once
#include <array>
#include <vector>

#include "bounds/vec.hpp"

namespace deburr {

class PlanarTriangulation {
public:
    struct Triangle {
        std::array<int, 3> vertex;     // side k runs from vertex k to the next
        std::array<int, 3> neighbour;  // across side k; −1 outside of all
        std::array<int, 3> mark;       // of side k, the same in the neighbour; −1: the side may be flipped
    };
    struct Side {
        int triangle = -1, k = 0;
    };
    /// The first thing met on the way from one point to another.
    struct ConnectResult {
        enum class End { there, vertex, marked } end = End::there;
        int vertex = -1;  // up to where the way now is an edge; marked: none
        Side crossed;     // marked: the side that is in the way
    };

    /// No two points may be the same. Up to three more follow them, the corners of the triangle around all.
    void start(const std::vector<Vec2>& points);

    /// Makes an edge of the way from a toward b, up to b, or to the first point on it. Changes nothing where a
    /// marked edge crosses it before.
    ConnectResult connect(int a, int b);
    /// The side that runs from a to b; its triangle is −1 if there is none.
    Side side(int a, int b) const;
    int mark(Side s) const { return at(s.triangle).mark[s.k]; }
    void set_mark(Side s, int mark);

    /// Flips what is not Delaunay and not marked, between triangles that are both `wanted`.
    void improve(const std::vector<char>& wanted);

    const std::vector<Triangle>& triangles() const { return triangles_; }
    Vec2 point(int v) const { return points_[v]; }
    int around(int v) const { return around_[v]; }  // a triangle

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
