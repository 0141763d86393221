#include "polygonizer/mesh/planar_triangulation.hpp"

#include <algorithm>
#include <cstdint>

#include "polygonizer/mesh/exact_orientation.hpp"

namespace deburr {
namespace {

// Index of a cell on the Hilbert curve through a grid of 2¹⁶ × 2¹⁶.
std::uint64_t hilbert(std::uint32_t x, std::uint32_t y) {
    constexpr std::uint32_t half = 1u << 15;
    std::uint64_t hilbert_index = 0;
    for (std::uint32_t s = half; s > 0; s >>= 1) {
        const bool right = x & s, up = y & s;
        hilbert_index = 4 * hilbert_index + (right ? (up ? 2 : 3) : (up ? 1 : 0));
        if (up) continue;
        if (right) {
            x = ~x;
            y = ~y;
        }
        std::swap(x, y);
    }
    return hilbert_index;
}

}  // namespace

double PlanarTriangulation::orient(int a, int b, int c) const { return orientation(point(a), point(b), point(c)); }

std::size_t PlanarTriangulation::corner_index(int t, int vertex) const {
    const auto& v = at(t).vertex;
    return v[0] == vertex ? 0 : v[1] == vertex ? 1 : 2;
}

PlanarTriangulation::Side PlanarTriangulation::twin(Side s) const {
    const int n = at(s.triangle).neighbour[s.k];
    if (n < 0) return {};
    return {n, int(corner_index(n, at(s.triangle).vertex[next(std::size_t(s.k))]))};
}

void PlanarTriangulation::set_side(int t, std::size_t k, int neighbour, int mark) {
    at(t).neighbour[k] = neighbour;
    at(t).mark[k] = mark;
    if (neighbour < 0) return;
    const std::size_t j = corner_index(neighbour, at(t).vertex[next(k)]);
    at(neighbour).neighbour[j] = t;
    at(neighbour).mark[j] = mark;
}

void PlanarTriangulation::put(int t, std::array<int, 3> vertex) {
    at(t).vertex = vertex;
    for (const int v : vertex) around_[v] = t;
}

void PlanarTriangulation::set_mark(Side s, int mark) {
    at(s.triangle).mark[s.k] = mark;
    if (const Side t = twin(s); t.triangle >= 0) at(t.triangle).mark[t.k] = mark;
}

void PlanarTriangulation::start(const std::vector<Vec2>& points) {
    points_ = points;
    triangles_.clear();
    Vec2 lo(infinity), hi(-infinity);
    for (const Vec2& x : points) {
        lo = glm::min(lo, x);
        hi = glm::max(hi, x);
    }
    const double size = std::max({hi.x - lo.x, hi.y - lo.y, 1e-100});
    const Vec2 middle = lo + 0.5 * (hi - lo);
    const int n = int(points.size());
    // At this distance circles through two points and one of the three added corners are nearly half-planes.
    const double far = 16 * std::max(size, epsilon * (std::abs(middle.x) + std::abs(middle.y)));
    points_.push_back(middle + Vec2(-far, -far));
    points_.push_back(middle + Vec2(3 * far, -far));
    points_.push_back(middle + Vec2(-far, 3 * far));
    around_.assign(points_.size(), 0);
    triangles_.push_back({{n, n + 1, n + 2}, {-1, -1, -1}, {-1, -1, -1}});
    last_ = 0;
    order_.clear();
    constexpr double cells = 65535;
    for (int v = 0; v < n; ++v) {
        const Vec2 x = (points[v] - lo) / size * cells;
        order_.push_back({n > 8 ? hilbert(std::uint32_t(x.x), std::uint32_t(x.y)) : 0, v});
    }
    std::sort(order_.begin(), order_.end());
    for (const auto& [hilbert_index, v] : order_) insert(v);
}

// A triangle that holds x. The walk terminates in Delaunay triangulations, which this one is up to rounding.
int PlanarTriangulation::locate(Vec2 x, int start) const {
    const auto beyond = [&](int t, std::size_t k) {
        return orientation(point(at(t).vertex[k]), point(at(t).vertex[next(k)]), x) < 0;
    };
    int t = start;
    for (std::size_t steps = 0; steps < triangles_.size(); ++steps) {
        std::size_t k = 0;
        while (k < 3 && !beyond(t, k)) ++k;
        if (k == 3) return t;
        t = at(t).neighbour[k];
    }
    for (t = 0; beyond(t, 0) || beyond(t, 1) || beyond(t, 2);) ++t;
    return t;
}

void PlanarTriangulation::insert(int v) {
    const int t = locate(point(v), last_);
    todo_.clear();
    int on = -1;
    for (int k = 0; k < 3; ++k)
        if (orient(at(t).vertex[k], at(t).vertex[next(std::size_t(k))], v) == 0) on = k;
    if (on < 0)
        split_triangle(t, v);
    else
        split_side({t, on}, v);
    legalize();
    last_ = around(v);
}

void PlanarTriangulation::split_triangle(int t, int v) {
    const Triangle old = at(t);
    const int u = int(triangles_.size());
    triangles_.resize(triangles_.size() + 2, old);
    const std::array<int, 3> parts{t, u, u + 1};
    for (std::size_t k = 0; k < 3; ++k) put(parts[k], {old.vertex[k], old.vertex[next(k)], v});
    for (std::size_t k = 0; k < 3; ++k) {
        set_side(parts[k], 0, old.neighbour[k], old.mark[k]);
        set_side(parts[k], 1, parts[next(k)], -1);
        todo_.push_back({parts[k], 0});
    }
}

void PlanarTriangulation::split_side(Side s, int v) {
    const Side o = twin(s);
    const auto k = std::size_t(s.k), j = std::size_t(o.k);
    const Triangle old = at(s.triangle), far = at(o.triangle);
    const int u = int(triangles_.size());
    triangles_.resize(triangles_.size() + 2, old);
    const int a = old.vertex[k], b = old.vertex[next(k)], c = old.vertex[before(k)], d = far.vertex[before(j)];
    put(s.triangle, {a, v, c});
    put(u, {v, b, c});
    put(o.triangle, {b, v, d});
    put(u + 1, {v, a, d});
    set_side(u, 1, old.neighbour[next(k)], old.mark[next(k)]);
    set_side(s.triangle, 2, old.neighbour[before(k)], old.mark[before(k)]);
    set_side(u + 1, 1, far.neighbour[next(j)], far.mark[next(j)]);
    set_side(o.triangle, 2, far.neighbour[before(j)], far.mark[before(j)]);
    set_side(s.triangle, 1, u, -1);
    set_side(o.triangle, 1, u + 1, -1);
    set_side(s.triangle, 0, u + 1, -1);
    set_side(u, 0, o.triangle, -1);
    todo_.insert(todo_.end(), {{u, 1}, {s.triangle, 2}, {u + 1, 1}, {o.triangle, 2}});
}

// Whether the two triangles of a side form a strictly convex quadrilateral.
bool PlanarTriangulation::may_flip(Side s) const {
    const Side o = twin(s);
    if (o.triangle < 0) return false;
    const auto k = std::size_t(s.k);
    const int a = at(s.triangle).vertex[k], b = at(s.triangle).vertex[next(k)], c = apex(s), d = apex(o);
    return orient(d, b, c) > 0 && orient(a, d, c) > 0;
}

// Whether the point across the side is inside the circumcircle by more than rounding, so that no two flips undo each
// other.
bool PlanarTriangulation::improves(Side s) const {
    const Side o = twin(s);
    if (o.triangle < 0) return false;
    const auto& v = at(s.triangle).vertex;
    const Vec2 d = point(apex(o)), a = point(v[0]) - d, b = point(v[1]) - d, c = point(v[2]) - d;
    const double aa = glm::dot(a, a), bb = glm::dot(b, b), cc = glm::dot(c, c);
    const double ab = a.x * b.y - a.y * b.x, bc = b.x * c.y - b.y * c.x, ca = c.x * a.y - c.y * a.x;
    const double size = cc * (std::abs(a.x * b.y) + std::abs(a.y * b.x)) +
                        aa * (std::abs(b.x * c.y) + std::abs(b.y * c.x)) +
                        bb * (std::abs(c.x * a.y) + std::abs(c.y * a.x));
    constexpr double slack = 8 * epsilon;  // products of four differences have about ten roundings
    return aa * bc + bb * ca + cc * ab > slack * size;
}

// Flips the side: in s's triangle it then runs from the neighbour's apex to the triangle's own.
void PlanarTriangulation::flip(Side s) {
    const Side o = twin(s);
    const auto k = std::size_t(s.k), j = std::size_t(o.k);
    const Triangle old = at(s.triangle), far = at(o.triangle);
    const int a = old.vertex[k], b = old.vertex[next(k)], c = old.vertex[before(k)], d = far.vertex[before(j)];
    put(s.triangle, {d, b, c});
    put(o.triangle, {a, d, c});
    set_side(s.triangle, 1, old.neighbour[next(k)], old.mark[next(k)]);
    set_side(s.triangle, 0, far.neighbour[before(j)], far.mark[before(j)]);
    set_side(o.triangle, 2, old.neighbour[before(k)], old.mark[before(k)]);
    set_side(o.triangle, 0, far.neighbour[next(j)], far.mark[next(j)]);
    set_side(s.triangle, 2, o.triangle, -1);
}

void PlanarTriangulation::legalize() {
    while (!todo_.empty()) {
        const Side s = todo_.back();
        todo_.pop_back();
        if (mark(s) >= 0 || !improves(s) || !may_flip(s)) continue;
        const int other = twin(s).triangle;
        flip(s);
        todo_.insert(todo_.end(), {{s.triangle, 0}, {s.triangle, 1}, {other, 0}, {other, 2}});
    }
}

PlanarTriangulation::Side PlanarTriangulation::side(int a, int b) const {
    const int first = around(a);
    int t = first;
    do {
        const std::size_t k = corner_index(t, a);
        if (at(t).vertex[next(k)] == b) return {t, int(k)};
        t = at(t).neighbour[before(k)];
    } while (t != first && t >= 0);
    if (t >= 0) return {};
    // The turn around an outermost point ends outside; the edges of these points are found from their other ends.
    const Side back = b < int(points_.size()) - 3 ? side(b, a) : Side{};
    return back.triangle < 0 ? back : twin(back);
}

PlanarTriangulation::ConnectResult PlanarTriangulation::connect(int a, int b) {
    // The triangle at a through which the way leaves.
    const int first = around(a);
    int t = first;
    Side s;
    do {
        const std::size_t k = corner_index(t, a);
        const int c = at(t).vertex[next(k)], d = at(t).vertex[before(k)];
        if (c == b) return {ConnectResult::End::there, b, {}};
        const double side_of_c = orient(a, b, c);
        if (side_of_c == 0 && glm::dot(point(c) - point(a), point(b) - point(a)) > 0)
            return {ConnectResult::End::vertex, c, {}};
        if (side_of_c < 0 && orient(a, b, d) > 0) {
            s = {t, int(next(k))};
            break;
        }
        t = at(t).neighbour[before(k)];
    } while (t != first);
    // The sides that the way crosses, from right to left, up to b or a point on the way.
    crossed_.clear();
    int end = b;
    while (true) {
        const int right = at(s.triangle).vertex[s.k], left = at(s.triangle).vertex[next(std::size_t(s.k))];
        if (mark(s) >= 0) return {ConnectResult::End::marked, -1, s};
        crossed_.push_back({right, left});
        const Side o = twin(s);
        const int c = apex(o);
        const double side_of_c = c == b ? 0 : orient(a, b, c);
        if (side_of_c == 0) {
            end = c;
            break;
        }
        // o's triangle is (left, right, c).
        s = {o.triangle, int(side_of_c < 0 ? before(std::size_t(o.k)) : next(std::size_t(o.k)))};
    }
    for (std::size_t i = 0; i < crossed_.size(); ++i) {
        const auto [right, left] = crossed_[i];
        const Side e = side(right, left);
        if (!may_flip(e)) {
            crossed_.push_back(crossed_[i]);
            continue;
        }
        const int c = apex(e), d = apex(twin(e));
        flip(e);
        if (c == a || c == end || d == a || d == end) continue;
        const double side_of_c = orient(a, end, c), side_of_d = orient(a, end, d);
        if ((side_of_c > 0) != (side_of_d > 0)) crossed_.push_back(side_of_c < 0 ? std::pair{c, d} : std::pair{d, c});
    }
    return {end == b ? ConnectResult::End::there : ConnectResult::End::vertex, end, {}};
}

void PlanarTriangulation::improve(const std::vector<char>& wanted) {
    todo_.clear();
    const auto offer = [&](Side s) {
        const int n = at(s.triangle).neighbour[s.k];
        if (n >= 0 && mark(s) < 0 && wanted[n]) todo_.push_back(s);
    };
    for (int t = 0; t < int(triangles_.size()); ++t)
        if (wanted[t])
            for (int k = 0; k < 3; ++k)
                if (at(t).neighbour[k] > t) offer({t, k});
    while (!todo_.empty()) {
        const Side s = todo_.back();
        todo_.pop_back();
        const int n = at(s.triangle).neighbour[s.k];
        if (n < 0 || mark(s) >= 0 || !wanted[n] || !improves(s) || !may_flip(s)) continue;
        flip(s);
        for (const Side fresh : {Side{s.triangle, 0}, {s.triangle, 1}, {n, 0}, {n, 2}}) offer(fresh);
    }
}

}  // namespace deburr
