// Points with rational coordinates, and triangulations of such points in a plane, all without rounding.
//
// The sign of a determinant is taken from its value in doubles where that is certain, and computed in GMP's rational
// numbers elsewhere.
#pragma once
#include <gmpxx.h>

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "bounds/vec.hpp"

namespace deburr {

/// A point with rational coordinates.
struct ExactPoint {
    std::array<mpq_class, 3> x;
    Vec3 near{0.0};  // x, exact to a unit in the last place

    ExactPoint() = default;
    explicit ExactPoint(Vec3 v);
    explicit ExactPoint(std::array<mpq_class, 3> at);
};

/// Lexicographic order of the coordinates; points on one line are in order along it.
bool comes_before(const ExactPoint& a, const ExactPoint& b);

/// Two coordinates of a point, ordered so that a plane that faces along the third axis is seen from outside.
struct PlaneAxes {
    int u = 0, v = 1;
    /// The two axes other than `left_out`.
    explicit PlaneAxes(int left_out) : u((left_out + 1) % 3), v((left_out + 2) % 3) {}
};

/// The orientation of the triangle abc, projected along the axis left out: 1 if counter-clockwise, −1 if clockwise, 0
/// if collinear. `scale` is an upper bound of all coordinates.
int orientation(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, PlaneAxes axes, double scale);

/// The sign of the volume of the tetrahedron abcd: 1 if abc is counter-clockwise as seen from d.
int orientation(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, const ExactPoint& d, double scale);

/// The intersection of the line ab with the plane pqr; a and b must lie on different sides of the plane.
ExactPoint on_plane(const ExactPoint& a, const ExactPoint& b, const ExactPoint& p, const ExactPoint& q,
                    const ExactPoint& r);

/// A triangulation of points in a plane that contains given edges. Points are indices in a list that is shared with
/// others.
class PlaneTriangulation {
public:
    /// Adds a point to the list and returns its index, or the index of an equal point.
    using NumberOf = std::function<int(const ExactPoint&)>;

    /// Begins with the triangle abc, which must be counter-clockwise in these axes. Keeps a reference to `points`;
    /// `scale` is an upper bound of their coordinates.
    PlaneTriangulation(const std::vector<ExactPoint>& points, NumberOf number_of, PlaneAxes axes, double scale, int a,
                       int b, int c);

    /// Inserts a point, which must lie in the first triangle.
    void insert(int point);
    /// Makes the segment ab a chain of edges of triangles: it is cut at points that lie on it and where it crosses
    /// given edges.
    void insert_edge(int a, int b);

    /// The triangles as indices of their corners, counter-clockwise, sorted.
    std::vector<std::array<int, 3>> triangles() const;

private:
    using Edge = std::pair<int, int>;  // directed, with a triangle on its left
    // The first step of the path from a point towards another.
    struct Start {
        Edge opposite;  // the edge opposite the point in the first triangle, from the path's right to its left
        int vertex;     // a vertex of that edge that lies on the path; −1: none
    };
    // The edges that a path crosses.
    struct Way {
        std::vector<Edge> crossed;  // each from the path's right to its left
        int end;  // the first vertex on the path; −1: the last of `crossed` is a given edge, which must not be crossed
    };

    int side(int a, int b, int c) const;
    int apex(int a, int b) const;
    void add(int a, int b, int c);
    void remove(int a, int b, int c);
    void split(int a, int b, int c, int point);
    void split_edge(int a, int b, int point);
    bool is_fixed(int a, int b) const { return fixed_.contains(std::minmax(a, b)); }
    void fix(int a, int b) { fixed_.insert(std::minmax(a, b)); }
    bool is_ahead(int from, int to, int point) const;
    std::optional<Start> start_between(int from, int to, int right, int left) const;
    std::optional<Start> start(int from, int to);
    Way way(int from, int to, Edge first) const;
    int cut_point(int from, int to, Edge given);
    void insert_across(int from, int to, Edge first, std::vector<Edge>& todo);
    void force(int a, int b, std::vector<Edge> crossed);

    const std::vector<ExactPoint>& points_;
    NumberOf number_of_;
    PlaneAxes axes_;
    double scale_;
    std::map<Edge, int> apex_;  // of a directed edge: the third corner of the triangle on its left
    std::map<int, int> next_;   // of a point: the other end of one edge with a triangle on its left
    std::set<Edge> fixed_;      // given edges, by their ends in rising order
    Edge hint_;                 // an edge from which insert() starts its search
};

}  // namespace deburr
