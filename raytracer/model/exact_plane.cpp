#include "raytracer/model/exact_plane.hpp"

#include <algorithm>
#include <utility>

namespace deburr {
namespace {

mpq_class determinant(const mpq_class& a, const mpq_class& b, const mpq_class& c, const mpq_class& d) {
    return a * d - b * c;
}

mpq_class volume(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, const ExactPoint& d) {
    std::array<mpq_class, 3> p, q, r;
    for (int k = 0; k < 3; ++k) {
        p[k] = b.x[k] - a.x[k];
        q[k] = c.x[k] - a.x[k];
        r[k] = d.x[k] - a.x[k];
    }
    return p[0] * determinant(q[1], q[2], r[1], r[2]) - p[1] * determinant(q[0], q[2], r[0], r[2]) +
           p[2] * determinant(q[0], q[1], r[0], r[1]);
}

}  // namespace

ExactPoint::ExactPoint(Vec3 v) : x{mpq_class(v.x), mpq_class(v.y), mpq_class(v.z)}, near(v) {}

ExactPoint::ExactPoint(std::array<mpq_class, 3> at)
    : x(std::move(at)), near(x[0].get_d(), x[1].get_d(), x[2].get_d()) {}

bool comes_before(const ExactPoint& a, const ExactPoint& b) {
    for (int k = 0; k < 3; ++k)
        if (const int c = cmp(a.x[k], b.x[k])) return c < 0;
    return false;
}

int orientation(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, PlaneAxes axes, double scale) {
    const auto [u, v] = axes;
    const double det =
        (b.near[u] - a.near[u]) * (c.near[v] - a.near[v]) - (b.near[v] - a.near[v]) * (c.near[u] - a.near[u]);
    // Differences are at most 2 scale with errors of 3 ε scale; the bound covers the products of such pairs and their
    // rounding.
    if (std::abs(det) > 64 * epsilon * scale * scale) return sign_of(det);
    return sgn(determinant(b.x[u] - a.x[u], b.x[v] - a.x[v], c.x[u] - a.x[u], c.x[v] - a.x[v]));
}

int orientation(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, const ExactPoint& d, double scale) {
    const double det = glm::dot(b.near - a.near, glm::cross(c.near - a.near, d.near - a.near));
    // Six products of three differences, each at most 2 scale with an error of 3 ε scale.
    if (std::abs(det) > 1024 * epsilon * scale * scale * scale) return sign_of(det);
    return sgn(volume(a, b, c, d));
}

ExactPoint on_plane(const ExactPoint& a, const ExactPoint& b, const ExactPoint& p, const ExactPoint& q,
                    const ExactPoint& r) {
    const mpq_class above = volume(p, q, r, a), below = volume(p, q, r, b);
    const mpq_class t = above / (above - below);
    std::array<mpq_class, 3> x;
    for (int k = 0; k < 3; ++k) x[k] = a.x[k] + t * (b.x[k] - a.x[k]);
    return ExactPoint(std::move(x));
}

PlaneTriangulation::PlaneTriangulation(const std::vector<ExactPoint>& points, NumberOf number_of, PlaneAxes axes,
                                       double scale, int a, int b, int c)
    : points_(points), number_of_(std::move(number_of)), axes_(axes), scale_(scale), hint_(a, b) {
    add(a, b, c);
}

int PlaneTriangulation::side(int a, int b, int c) const {
    return orientation(points_[a], points_[b], points_[c], axes_, scale_);
}

int PlaneTriangulation::apex(int a, int b) const {
    const auto found = apex_.find({a, b});
    return found == apex_.end() ? -1 : found->second;
}

void PlaneTriangulation::add(int a, int b, int c) {
    apex_[{a, b}] = c;
    apex_[{b, c}] = a;
    apex_[{c, a}] = b;
    next_[a] = b;
    next_[b] = c;
    next_[c] = a;
    hint_ = {a, b};
}

void PlaneTriangulation::remove(int a, int b, int c) {
    apex_.erase({a, b});
    apex_.erase({b, c});
    apex_.erase({c, a});
}

void PlaneTriangulation::split(int a, int b, int c, int point) {
    remove(a, b, c);
    add(a, b, point);
    add(b, c, point);
    add(c, a, point);
}

void PlaneTriangulation::split_edge(int a, int b, int point) {
    const int left = apex(a, b), right = apex(b, a);
    if (is_fixed(a, b)) {
        fixed_.erase(std::minmax(a, b));
        fix(a, point);
        fix(point, b);
    }
    if (left >= 0) {
        remove(a, b, left);
        add(a, point, left);
        add(point, b, left);
    }
    if (right >= 0) {
        remove(b, a, right);
        add(b, point, right);
        add(point, a, right);
    }
}

void PlaneTriangulation::insert(int point) {
    if (next_.contains(point)) return;
    // Walks from triangle to triangle across an edge that the point is beyond; if that goes in circles, tries all
    // triangles.
    const auto look = [&](int a, int b, int c, Edge& beyond) {
        const std::array<int, 3> v{a, b, c};
        int on = -1;
        for (int k = 0; k < 3; ++k) {
            const int s = side(v[k], v[(k + 1) % 3], point);
            if (s < 0) {
                beyond = {v[(k + 1) % 3], v[k]};
                return false;
            }
            if (s == 0) on = k;
        }
        if (on < 0)
            split(a, b, c, point);
        else
            split_edge(v[on], v[(on + 1) % 3], point);
        return true;
    };
    Edge at = hint_;
    for (std::size_t step = 0; step < apex_.size(); ++step) {
        const int c = apex(at.first, at.second);
        if (c < 0) break;
        if (look(at.first, at.second, c, at)) return;
    }
    for (const auto& t : triangles())
        if (look(t[0], t[1], t[2], at)) return;
}

void PlaneTriangulation::insert_edge(int a, int b) {
    std::vector<Edge> todo{{a, b}};
    while (!todo.empty()) {
        const auto [from, to] = todo.back();
        todo.pop_back();
        if (from == to) continue;
        if (apex(from, to) >= 0 || apex(to, from) >= 0) {
            fix(from, to);
            continue;
        }
        const std::optional<Start> begin = start(from, to);
        if (!begin) continue;  // does not happen for points within the first triangle
        if (begin->vertex >= 0) {
            todo.push_back({begin->vertex, to});
            fix(from, begin->vertex);
        } else {
            insert_across(from, to, begin->opposite, todo);
        }
    }
}

// Whether a point on the line through `from` and `to` is on the same side of `from` as `to`.
bool PlaneTriangulation::is_ahead(int from, int to, int point) const {
    const int k = cmp(points_[to].x[axes_.u], points_[from].x[axes_.u]) != 0 ? axes_.u : axes_.v;
    return cmp(points_[point].x[k], points_[from].x[k]) * cmp(points_[to].x[k], points_[from].x[k]) > 0;
}

// The start of the path if it leads through the triangle (from, right, left).
std::optional<PlaneTriangulation::Start> PlaneTriangulation::start_between(int from, int to, int right,
                                                                           int left) const {
    const int r = side(from, to, right), l = side(from, to, left);
    int vertex = -1;
    if (r == 0 && is_ahead(from, to, right)) vertex = right;
    if (l == 0 && is_ahead(from, to, left)) vertex = left;
    if (vertex < 0 && !(r < 0 && l > 0)) return std::nullopt;
    return Start{{right, left}, vertex};
}

// Searches the triangles around `from`: counter-clockwise from next_, then clockwise.
std::optional<PlaneTriangulation::Start> PlaneTriangulation::start(int from, int to) {
    const int first = next_[from];
    for (int right = first, left; (left = apex(from, right)) >= 0; right = left) {
        if (const auto found = start_between(from, to, right, left)) return found;
        if (left == first) break;
    }
    for (int left = first, right; (right = apex(left, from)) >= 0; left = right)
        if (const auto found = start_between(from, to, right, left)) return found;
    return std::nullopt;
}

// Follows the path across triangles until it meets a vertex or a given edge.
PlaneTriangulation::Way PlaneTriangulation::way(int from, int to, Edge first) const {
    Way way{{first}, -1};
    for (auto [right, left] = first; !is_fixed(right, left);) {
        const int beyond = apex(left, right);
        const int s = beyond == to ? 0 : side(from, to, beyond);
        if (s == 0) {
            way.end = beyond;
            break;
        }
        (s > 0 ? left : right) = beyond;
        way.crossed.push_back({right, left});
    }
    return way;
}

// The index of the point where the path meets a given edge.
int PlaneTriangulation::cut_point(int from, int to, Edge given) {
    const ExactPoint &p = points_[given.first], &q = points_[given.second], &s = points_[from], &t = points_[to];
    const auto area = [&](const ExactPoint& x) {
        return determinant(t.x[axes_.u] - s.x[axes_.u], t.x[axes_.v] - s.x[axes_.v], x.x[axes_.u] - s.x[axes_.u],
                           x.x[axes_.v] - s.x[axes_.v]);
    };
    const mpq_class below = area(p), above = area(q), f = below / (below - above);
    std::array<mpq_class, 3> x;
    for (int k = 0; k < 3; ++k) x[k] = p.x[k] + f * (q.x[k] - p.x[k]);
    return number_of_(ExactPoint(std::move(x)));
}

// Makes the path across `first` an edge, up to the next vertex; appends the remaining parts to `todo`.
void PlaneTriangulation::insert_across(int from, int to, Edge first, std::vector<Edge>& todo) {
    Way passed = way(from, to, first);
    if (passed.end < 0) {
        const auto [right, left] = passed.crossed.back();
        const int cut = cut_point(from, to, {right, left});
        split_edge(right, left, cut);
        todo.push_back({cut, to});
        todo.push_back({from, cut});
        return;
    }
    if (passed.end != to) todo.push_back({passed.end, to});
    force(from, passed.end, std::move(passed.crossed));
    fix(from, passed.end);
}

// Flips the edges that cross the path from a to b until none does [Sloan 1993].
void PlaneTriangulation::force(int a, int b, std::vector<Edge> crossed) {
    for (std::size_t i = 0; i < crossed.size(); ++i) {
        const auto [right, left] = crossed[i];
        const int near = apex(right, left), far = apex(left, right);
        // An edge can be flipped if its four corners form a convex quadrilateral; others wait.
        if (side(near, right, far) <= 0 || side(far, left, near) <= 0) {
            crossed.push_back(crossed[i]);
            continue;
        }
        remove(right, left, near);
        remove(left, right, far);
        add(near, right, far);
        add(far, left, near);
        const int n = near == a || near == b ? 0 : side(a, b, near), f = far == a || far == b ? 0 : side(a, b, far);
        if (n * f < 0) crossed.push_back(n < 0 ? Edge{near, far} : Edge{far, near});
    }
}

std::vector<std::array<int, 3>> PlaneTriangulation::triangles() const {
    std::vector<std::array<int, 3>> all;
    for (const auto& [edge, c] : apex_)  // each triangle once, by its least corner
        if (edge.first < edge.second && edge.first < c) all.push_back({edge.first, edge.second, c});
    return all;
}

}  // namespace deburr
