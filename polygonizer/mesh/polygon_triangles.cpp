#include "polygonizer/mesh/polygon_triangles.hpp"

#include <algorithm>

#include "polygonizer/mesh/edge_chain.hpp"
#include "polygonizer/mesh/loop_ears.hpp"
#include "polygonizer/mesh/planar_triangulation.hpp"
#include "polygonizer/mesh/small_polygon.hpp"

namespace deburr {
namespace {

using TriangleVertices = std::array<int, 3>;
using ConnectResult = PlanarTriangulation::ConnectResult;
// The projection along the coordinate axis nearest to the normal.
class View {
public:
    explicit View(Vec3 normal) {
        const Vec3 m = glm::abs(normal);
        const int drop = greatest_axis(m);
        x_ = (drop + 1) % 3;
        y_ = (drop + 2) % 3;
        if (normal[drop] < 0) std::swap(x_, y_);
    }
    Vec2 operator()(Vec3 x) const { return {x[x_] + 0.0, x[y_] + 0.0}; }  // adding 0 turns −0 into 0

private:
    int x_, y_;
};

/// Triangulates polygons; keeps its memory from one to the next.
class PolygonWork {
public:
    void run(const std::vector<std::vector<int>>& loops, const std::vector<Vec3>& positions, Vec3 normal,
             PolygonTriangles& out) {
        out_ = &out;
        gather(loops, positions, View(normal));
        if (corners_ == 0) return;
        plane_.start(points_);
        for (const Edge& side : sides_) constraints_.push_back({side.a, side.b, side.first, side.last});
        bool connected = connect_all();
        if (connected) {
            wind();
            plane_.improve(within_);
            collect();
            connected = drop_touches(positions, View(normal));
        }
        const bool plain = connected && points_.size() == corners_ && touches_.empty() && simple_winding_;
        if (plain || (connected && covers(loops))) return;
        out.crosses_itself = true;
        const View view(normal);
        std::vector<std::vector<Vec2>> plane_points(loops.size());
        for (std::size_t k = 0; k < loops.size(); ++k)
            for (const int v : loops[k]) plane_points[k].push_back(view(positions[v]));
        out.triangles = loop_ears(loops, plane_points);
    }

private:
    // A part of a side, from point a, where its vertex is `first`, to point b, where it is `last`. Where the part ends
    // within the side, the code of a touch stands for the vertex.
    struct Edge {
        int a, b, first, last;
        int next = -1;  // the next part along the same edge of the triangulation; −1: none
    };
    // A place where a side passes through a point.
    struct Touch {
        int point;
        int vertex = unknown;  // the vertex that it touches there; `own`: none, because all that lies left of the side
                               // there is its own
    };
    static constexpr int unknown = -1, own = -2, first_touch = -3;
    static int touch_code(std::size_t touch) { return first_touch - int(touch); }
    static bool is_touch(int code) { return code <= first_touch; }
    Touch& touch(int code) { return touches_[first_touch - code]; }

    // Two vertices in one point that change from one to the other across side k of the triangle.
    struct Joint {
        int triangle;
        std::size_t k;
        int right, left;
    };

    void gather(const std::vector<std::vector<int>>& loops, const std::vector<Vec3>& positions, const View& view) {
        points_.clear();
        sides_.clear();
        constraints_.clear();
        edges_.clear();
        still_.clear();
        joints_.clear();
        found_.clear();
        touches_.clear();
        corners_ = 0;
        for (const auto& loop : loops)
            for (const int v : loop) {
                const Vec2 x = view(positions[v]);
                found_.push_back({{x.x, x.y}, int(corners_++)});
            }
        std::sort(found_.begin(), found_.end());
        point_of_.resize(corners_);
        for (std::size_t k = 0; k < found_.size(); ++k) {
            const auto& [x, corner] = found_[k];
            if (k == 0 || x != found_[k - 1].first) points_.push_back({x.first, x.second});
            point_of_[corner] = int(points_.size()) - 1;
        }
        vertex_at_.assign(points_.size() + 3, -1);
        several_.assign(points_.size() + 3, false);
        touched_.assign(points_.size() + 3, false);
        std::size_t first = 0;
        for (const auto& loop : loops) {
            for (std::size_t k = 0; k < loop.size(); ++k) {
                const std::size_t n = k + 1 == loop.size() ? 0 : k + 1;
                const int a = point_of_[first + k], b = point_of_[first + n];
                if (int& v = vertex_at_[a]; v < 0)
                    v = loop[k];
                else if (v != loop[k])
                    several_[a] = true;
                if (a != b)
                    sides_.push_back({a, b, loop[k], loop[n]});
                else if (loop[k] != loop[n])
                    still_.push_back({a, a, loop[k], loop[n]});
            }
            first += loop.size();
        }
    }

    // Makes edges of all sides; false if they cross so often that there seems to be no end.
    bool connect_all() {
        std::size_t crossings_left = 8 * corners_ + 64;
        std::reverse(constraints_.begin(), constraints_.end());
        while (!constraints_.empty()) {
            const Edge constraint = constraints_.back();
            constraints_.pop_back();
            const ConnectResult found = plane_.connect(constraint.a, constraint.b);
            if (found.end == ConnectResult::End::there) {
                attach(constraint, found.vertex);
            } else if (found.end == ConnectResult::End::vertex) {
                route_through(constraint, found.vertex);
            } else {
                if (crossings_left-- == 0) return false;
                out_->crosses_itself = true;
                cross(constraint, found.crossed);
            }
        }
        return true;
    }

    void attach(const Edge& edge, int b) {
        const PlanarTriangulation::Side s = plane_.side(edge.a, b);
        edges_.push_back(edge);
        edges_.back().next = plane_.mark(s);
        plane_.set_mark(s, int(edges_.size()) - 1);
    }

    // Splits the part of a side at the point and adds the triangle without area.
    void route_through(const Edge& constraint, int point) {
        const int v = touch_code(touches_.size());
        touches_.push_back({point});
        touched_[point] = true;
        out_->triangles.push_back({constraint.first, constraint.last, v});
        constraints_.push_back({point, constraint.b, v, constraint.last});
        constraints_.push_back({constraint.a, point, constraint.first, v});
    }

    void cross(const Edge& constraint, PlanarTriangulation::Side crossed) {
        const auto& t = plane_.triangles()[crossed.triangle];
        const int c = t.vertex[crossed.k], d = t.vertex[PlanarTriangulation::next(std::size_t(crossed.k))];
        const auto off = [&](int point, int from, int to) {
            return distance_to_segment(plane_.point(point), plane_.point(from), plane_.point(to));
        };
        const double of_c = off(c, constraint.a, constraint.b), of_d = off(d, constraint.a, constraint.b);
        const double of_a = off(constraint.a, c, d), of_b = off(constraint.b, c, d);
        if (std::min(of_c, of_d) <= std::min(of_a, of_b)) return route_through(constraint, of_c <= of_d ? c : d);
        constraints_.push_back(constraint);
        int k = plane_.mark(crossed);
        plane_.set_mark(crossed, -1);
        for (; k >= 0; k = edges_[k].next) route_through(edges_[k], of_a <= of_b ? constraint.a : constraint.b);
    }

    // Finds how often the sides wind around each triangle: 0 far outside, and one more on the left of each side.
    void wind() {
        const auto& triangles = plane_.triangles();
        constexpr int not_yet = std::numeric_limits<int>::min();
        winding_.assign(triangles.size(), not_yet);
        within_.assign(triangles.size(), false);
        const int start = plane_.around(int(points_.size()));
        winding_[start] = 0;
        todo_ = {start};
        simple_winding_ = true;
        while (!todo_.empty()) {
            const int t = todo_.back();
            todo_.pop_back();
            const int w = winding_[t];
            within_[t] = w != 0;
            simple_winding_ &= w == 0 || w == 1;
            for (std::size_t k = 0; k < 3; ++k) {
                const int n = triangles[t].neighbour[k];
                if (n < 0 || winding_[n] != not_yet) continue;
                winding_[n] = w - along({t, int(k)});
                todo_.push_back(n);
            }
        }
        out_->crosses_itself |= !simple_winding_;
    }

    // The number of sides that run along this edge, less that of those that run back.
    int along(PlanarTriangulation::Side s) const {
        const int from = plane_.triangles()[s.triangle].vertex[s.k];
        int sum = 0;
        for (int k = plane_.mark(s); k >= 0; k = edges_[k].next) sum += edges_[k].a == from ? 1 : -1;
        return sum;
    }

    void emit(const TriangleVertices& t, int times) {
        for (; times > 0; --times) out_->triangles.push_back(t);
        for (; times < 0; ++times) out_->triangles.push_back({t[1], t[0], t[2]});
    }

    void collect() {
        const auto& triangles = plane_.triangles();
        vertices_.assign(triangles.size(), {});
        for (std::size_t t = 0; t < triangles.size(); ++t)
            for (std::size_t k = 0; k < 3; ++k) vertices_[t][k] = vertex_at_[triangles[t].vertex[k]];
        for (std::size_t p = 0; p < points_.size(); ++p)
            if (several_[p] || touched_[p]) part(int(p));
        for (TriangleVertices& t : out_->triangles)
            for (int& v : t)
                if (is_touch(v)) v = touched_vertex(v);
        for (std::size_t t = 0; t < triangles.size(); ++t) emit(vertices_[t], winding_[t]);
        for (const Joint& j : joints_) emit({j.right, vertices_[j.triangle][j.k], j.left}, winding_[j.triangle]);
    }

    int touched_vertex(int code) {
        const Touch& t = touch(code);
        return t.vertex == own ? code : t.vertex == unknown ? vertex_at_[t.point] : t.vertex;
    }

    // Removes touches whose vertex is `own`: they are no vertices, so the triangles around them are replaced by others.
    bool drop_touches(const std::vector<Vec3>& positions, const View& view) {
        const auto plane_point = [&](int v) { return is_touch(v) ? points_[touch(v).point] : view(positions[v]); };
        for (std::size_t k = 0; k < touches_.size(); ++k) {
            if (touches_[k].vertex != own) continue;
            std::vector<int> ring;
            if (!take_ring(out_->triangles, touch_code(k), ring)) return false;
            std::vector<Vec2> plane_points;
            for (const int v : ring) plane_points.push_back(plane_point(v));
            for (const TriangleVertices& t : small_polygon(plane_points))
                out_->triangles.push_back({ring[t[0]], ring[t[1]], ring[t[2]]});
        }
        return true;
    }

    // The vertex, or touch, that a side along s has at `point`; of a side that leaves the point, or of one that enters
    // it.
    int vertex_by(PlanarTriangulation::Side s, int point, bool leaves) const {
        int v = vertex_at_[point];
        for (int k = plane_.mark(s); k >= 0; k = edges_[k].next) {
            const Edge& e = edges_[k];
            if ((e.a == point) != leaves) continue;
            v = leaves ? e.first : e.last;
            if (!is_touch(v)) break;
        }
        return v;
    }

    // Decides touches x and y between which a wedge at the point lies: either the wedge is one side's own, or the sides
    // touch a vertex there.
    void settle(int& x, int& y, int point) {
        if (is_touch(x) && x == y) {
            touch(x).vertex = own;
            return;
        }
        int known = is_touch(x) ? y : x;
        if (is_touch(known)) known = vertex_at_[point];
        for (int* v : {&x, &y}) {
            if (!is_touch(*v)) continue;
            if (touch(*v).vertex == unknown) touch(*v).vertex = known;
            *v = touch(*v).vertex;
        }
    }

    // Determines which of several vertices in one point each triangle around it has: between two sides, the one from
    // which the right side leaves. If the left side enters at another vertex, a triangle without area joins both; the
    // edges that then remain open between vertices are filled by triangles within the point.
    void part(int point) {
        struct Spoke {
            int triangle;
            std::size_t k;  // the point's corner in the triangle
        };
        const auto& triangles = plane_.triangles();
        std::vector<Spoke> fan;
        int t = plane_.around(point);
        do {
            const auto& v = triangles[t].vertex;
            const std::size_t k = v[0] == point ? 0 : v[1] == point ? 1 : 2;
            fan.push_back({t, k});
            t = triangles[t].neighbour[PlanarTriangulation::before(k)];
        } while (t != fan[0].triangle);
        const auto starts = [&](const Spoke& s) { return triangles[s.triangle].mark[s.k] >= 0; };
        const auto first = std::find_if(fan.begin(), fan.end(), starts);
        if (first == fan.end()) return;
        std::rotate(fan.begin(), first, fan.end());
        EdgeChain open;
        for (const Edge& e : still_)
            if (e.a == point) open.add(e.first, e.last);
        for (std::size_t begin = 0, end; begin < fan.size(); begin = end) {
            end = begin + 1;
            while (end < fan.size() && !starts(fan[end])) ++end;
            const Spoke &right = fan[begin], &left = fan[end - 1];
            const int w = winding_[right.triangle];
            if (w == 0) continue;
            int x = vertex_by({right.triangle, int(right.k)}, point, w > 0);
            int y = vertex_by({left.triangle, int(PlanarTriangulation::before(left.k))}, point, w < 0);
            settle(x, y, point);
            for (std::size_t i = begin; i < end; ++i) vertices_[fan[i].triangle][fan[i].k] = x;
            if (x == y) continue;
            joints_.push_back({left.triangle, PlanarTriangulation::before(left.k), x, y});
            open.add(y, x, -w);
        }
        fill(open, point);
    }

    /// Closes the open edges between vertices in one point by triangles.
    void fill(EdgeChain& open, int point) {
        const auto edges = open.rest();
        const int apex = vertex_at_[point];
        for (const auto& [ends, times] : edges)
            if (ends.first != apex && ends.second != apex) emit({apex, ends.first, ends.second}, times);
    }

    // Whether the triangles' edges cancel except for the loops.
    bool covers(const std::vector<std::vector<int>>& loops) const {
        EdgeChain chain;
        for (const TriangleVertices& t : out_->triangles)
            for (std::size_t k = 0; k < 3; ++k) chain.add(t[k], t[PlanarTriangulation::next(k)]);
        for (const auto& loop : loops)
            for (std::size_t k = 0; k < loop.size(); ++k) chain.add(loop[k], loop[(k + 1) % loop.size()], -1);
        return chain.rest().empty();
    }

    PlanarTriangulation plane_;
    PolygonTriangles* out_ = nullptr;
    std::size_t corners_ = 0;
    std::vector<std::pair<std::pair<double, double>, int>> found_;  // places and corners, sorted
    std::vector<Vec2> points_;
    std::vector<int> point_of_;                              // by corner
    std::vector<int> vertex_at_;                             // by point: the first vertex there
    std::vector<char> several_;                              // by point: whether there are more vertices
    std::vector<Edge> sides_, constraints_, edges_, still_;  // still_: between vertices in one point
    std::vector<Touch> touches_;
    std::vector<char> touched_;  // by point: whether a side passes through it
    bool simple_winding_ = true;
    std::vector<int> winding_, todo_;
    std::vector<char> within_;
    std::vector<Joint> joints_;
    std::vector<TriangleVertices> vertices_;
};

}  // namespace

PolygonTriangles triangulate(const std::vector<std::vector<int>>& loops, const std::vector<Vec3>& positions,
                             Vec3 normal) {
    PolygonTriangles result;
    if (loops.size() == 1 && loops[0].size() == 3) {
        result.triangles = {{loops[0][0], loops[0][1], loops[0][2]}};
        return result;
    }
    if (loops.size() == 1 && loops[0].size() == 4) {
        const View view(normal);
        std::array<Vec2, 4> x;
        for (std::size_t k = 0; k < 4; ++k) x[k] = view(positions[loops[0][k]]);
        if (const int from = quadrilateral_diagonal(x); from >= 0) {
            const auto v = [&](int k) { return loops[0][(from + k) % 4]; };
            result.triangles = {{v(0), v(1), v(2)}, {v(2), v(3), v(0)}};
            return result;
        }
    }
    thread_local PolygonWork work;
    work.run(loops, positions, normal, result);
    return result;
}

std::vector<std::array<int, 3>> triangles_of(const std::vector<std::vector<int>>& loops,
                                             const std::vector<Vec3>& positions, Vec3 normal) {
    return triangulate(loops, positions, normal).triangles;
}

}  // namespace deburr
