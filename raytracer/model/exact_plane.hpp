// Points with rational coordinates, and triangulations of them in a plane: nothing here is rounded.
//
// Signs of determinants are taken from doubles where the error of these leaves no doubt, and from GMP's rational
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

struct ExactPoint {
    std::array<mpq_class, 3> x;
    Vec3 near{0.0};  // x, to a unit in the last place

    ExactPoint() = default;
    explicit ExactPoint(Vec3 v);
    explicit ExactPoint(std::array<mpq_class, 3> at);
};

/// Whether `a` comes before `b` in the order by coordinates; along a line that is one of its directions.
bool comes_before(const ExactPoint& a, const ExactPoint& b);

/// Two coordinates of a point, in the order in which a plane that faces along the axis left out is seen from outside.
struct PlaneAxes {
    int u = 0, v = 1;
    explicit PlaneAxes(int left_out) : u((left_out + 1) % 3), v((left_out + 2) % 3) {}
};

/// −1, 0 or 1: the orientation of abc in the plane of these axes, 1 where it is counter-clockwise. `scale` is at least
/// as large as every coordinate.
int orientation(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, PlaneAxes axes, double scale);

/// −1, 0 or 1: the sign of the volume of abcd, 1 where abc is counter-clockwise seen from d.
int orientation(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, const ExactPoint& d, double scale);

/// The point in which the line through a and b goes through the plane pqr; a and b lie on different sides of that.
ExactPoint on_plane(const ExactPoint& a, const ExactPoint& b, const ExactPoint& p, const ExactPoint& q,
                    const ExactPoint& r);

/// A triangulation of points in a plane, some of whose edges are given. Points are numbers in a list that others add
/// to.
class PlaneTriangulation {
public:
    /// Adds a point, and returns its number; equal points have one.
    using NumberOf = std::function<int(const ExactPoint&)>;

    /// The triangle abc, counter-clockwise in the plane of these axes. Keeps references.
    PlaneTriangulation(const std::vector<ExactPoint>& points, NumberOf number_of, PlaneAxes axes, double scale, int a,
                       int b, int c);

    /// The point must lie in the first triangle.
    void insert(int point);
    /// Makes the edges from a to b edges of triangles: it is cut at points that lie on it and where it crosses others.
    void insert_edge(int a, int b);

    /// Triangles by the numbers of their corners, counter-clockwise, in rising order.
    std::vector<std::array<int, 3>> triangles() const;

private:
    using Edge = std::pair<int, int>;  // directed: a triangle is on its left
    // Where a way from a point begins.
    struct Start {
        Edge opposite;  // the edge of the first triangle that is opposite the point, to the way's right and left
        int vertex;     // of that edge, which lies on the way; −1: none
    };
    // What a way passes.
    struct Way {
        std::vector<Edge> crossed;  // edges, each from the way's right to its left
        int end;  // the first vertex on it; −1: the last of `crossed` is given and cannot be crossed
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
    std::map<Edge, int> apex_;
    std::map<int, int> next_;  // of a point: the other end of one edge, that has a triangle on its left
    std::set<Edge> fixed_;
    Edge hint_;
};

}  // namespace deburr
