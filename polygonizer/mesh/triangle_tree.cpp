#include "polygonizer/mesh/triangle_tree.hpp"

#include <algorithm>
#include <ranges>

#include "polygonizer/mesh/exact_orientation.hpp"

namespace deburr {
namespace {

constexpr std::size_t leaf_size = 4;

// Whether the segment from x to x + d meets the box; no component of d is 0.
bool meets(const Box& box, Vec3 x, Vec3 d) {
    double lo = 0, hi = 1;
    for (int k = 0; k < 3; ++k) {
        const double a = (box.lo[k] - x[k]) / d[k], b = (box.hi[k] - x[k]) / d[k];
        lo = std::max(lo, std::min(a, b));
        hi = std::min(hi, std::max(a, b));
    }
    constexpr double slack = 16 * epsilon;  // rounding of differences and quotients
    return lo <= hi + slack * (1 + std::abs(hi));
}

}  // namespace

TriangleTree::TriangleTree(const Mesh& mesh) : mesh_(mesh) {
    const std::size_t count = mesh.triangles.size();
    std::vector<Item> items;
    items.reserve(count);
    boxes_.reserve(count);
    order_.reserve(count);
    nodes_.reserve(count);
    for (std::size_t t = 0; t < count; ++t) {
        const Box& box = boxes_.emplace_back(bounding_box(mesh, mesh.triangles[t]));
        items.push_back({box.lo + box.hi, int(t)});
    }
    if (count > 0) build(items);
}

void TriangleTree::build(std::span<Item> items) {
    const auto at = nodes_.size();
    nodes_.push_back({{}, int(at) + 1, int(order_.size()), int(items.size())});
    if (items.size() <= leaf_size) {
        for (const Item& item : items) {
            nodes_[at].box = hull(nodes_[at].box, boxes_[item.triangle]);
            order_.push_back(item.triangle);
        }
        return;
    }
    Box middles;
    for (const Item& item : items) middles = hull(middles, Box{item.middle, item.middle});
    const int axis = greatest_axis(middles.hi - middles.lo);
    const auto half = std::ptrdiff_t(items.size() / 2);
    std::nth_element(items.begin(), items.begin() + half, items.end(), [&](const Item& s, const Item& t) {
        return s.middle[axis] != t.middle[axis] ? s.middle[axis] < t.middle[axis] : s.triangle < t.triangle;
    });
    build(items.first(std::size_t(half)));
    const auto upper = nodes_.size();
    build(items.subspan(std::size_t(half)));
    nodes_[at].box = hull(nodes_[at + 1].box, nodes_[upper].box);
    nodes_[at].end = int(nodes_.size());
}

std::optional<int> TriangleTree::winding(Vec3 x) const {
    const Box all = box();
    if (all.empty() || !all.contains(x)) return 0;
    // Along the mesh's thinnest extent, and in another direction where that hits an edge.
    const Vec3 size = all.hi - all.lo;
    const int axis = size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2;
    constexpr std::array<Vec2, 5> leans{Vec2{0.0718, 0.0431}, Vec2{-0.0613, 0.0877}, Vec2{0.0391, -0.0967},
                                        Vec2{-0.0829, -0.0287}, Vec2{0.0171, 0.0613}};
    for (std::size_t k = 0; k < leans.size(); ++k) {
        Vec3 d;
        d[axis] = k % 2 ? -1 : 1;
        d[(axis + 1) % 3] = leans[k].x;
        d[(axis + 2) % 3] = leans[k].y;
        const double reach = d[axis] > 0 ? all.hi[axis] - x[axis] : x[axis] - all.lo[axis];
        if (const auto found = winding(x, x + d * (1.01 * reach + 1e-3 * size[axis] + epsilon * largest(x))))
            return found;
    }
    return std::nullopt;
}

// The winding number by the crossings of the segment from x to `far`, which is outside; none if it meets a vertex or
// edge.
std::optional<int> TriangleTree::winding(Vec3 x, Vec3 far) const {
    const Vec3 d = far - x;
    int sum = 0;
    for (std::size_t at = 0; at < nodes_.size();) {
        const Node& n = nodes_[at];
        if (!meets(n.box, x, d)) {
            at = std::size_t(n.end);
            continue;
        }
        if (!is_leaf(n, int(at++))) continue;
        for (int k = n.first; k < n.first + n.count; ++k) {
            const int t = order_[k];
            if (!meets(boxes_[t], x, d)) continue;
            const auto& v = mesh_.triangles[t].vertex;
            const Vec3 a = mesh_.positions[v[0]], b = mesh_.positions[v[1]], c = mesh_.positions[v[2]];
            const double here = orientation(a, b, c, x), there = orientation(a, b, c, far);
            if (here == 0 && there == 0) continue;
            if ((here > 0 && there > 0) || (here < 0 && there < 0)) continue;
            const double ab = orientation(x, far, a, b), bc = orientation(x, far, b, c), ca = orientation(x, far, c, a);
            const double least = std::min({ab, bc, ca}), most = std::max({ab, bc, ca});
            if (least < 0 && most > 0) continue;
            if (least == 0 || most == 0 || here == 0 || there == 0) return std::nullopt;
            sum += here < 0 ? 1 : -1;
        }
    }
    return sum;
}

namespace {

using TrianglePositions = std::array<Vec3, 3>;

// The sign of x, or 0 if |x| ≤ slack · unit.
int sign(double x, double slack = 0, double unit = 1) { return std::abs(x) <= slack * unit ? 0 : x > 0 ? 1 : -1; }

double twice_area(const TrianglePositions& t) { return glm::length(glm::cross(t[1] - t[0], t[2] - t[0])); }

// Tells on which side of a triangle's plane a point is: −1, 1, or 0 within the slack. Its arithmetic is exact only
// where rounding could change the answer.
class Sides {
public:
    Sides(const TrianglePositions& plane, double slack) : plane_(plane) {
        const Vec3 u = plane[1] - plane[0], v = plane[2] - plane[0];
        normal_ = glm::cross(u, v);
        least_ = slack * twice_area(plane);
        // A bound for the rounding of differences, products, and sums of two and three, by the sizes of what is added.
        constexpr double rounding = 16 * epsilon;
        rounding_ = rounding * size(u) * size(v);
    }
    int of(Vec3 x) const {
        const Vec3 d = x - plane_[0];
        const double height = glm::dot(normal_, d), off = rounding_ * size(d);
        if (std::abs(height) > least_ + off) return height > 0 ? 1 : -1;
        if (std::abs(height) + off < least_) return 0;
        return sign(orientation(plane_[0], plane_[1], plane_[2], x), least_);
    }

private:
    static double size(Vec3 d) { return std::abs(d.x) + std::abs(d.y) + std::abs(d.z); }

    const TrianglePositions& plane_;
    Vec3 normal_;
    double least_, rounding_;
};

// Whether the segment, whose ends are on these sides of the triangle's plane, passes through the triangle's interior.
bool pierces(Vec3 p, int side_of_p, Vec3 q, int side_of_q, const TrianglePositions& t, double slack) {
    if (side_of_p == 0 || side_of_p != -side_of_q) return false;
    const double length = glm::distance(p, q);
    const auto side = [&](std::size_t k) {
        const Vec3 a = t[k], b = t[(k + 1) % 3];
        return sign(orientation(p, q, a, b), slack, length * glm::distance(a, b));
    };
    const int first = side(0);
    return first != 0 && first == side(1) && first == side(2);
}

// Whether two triangles in one plane overlap: no side of either has the other triangle beyond it.
bool overlap(const TrianglePositions& s, const TrianglePositions& t, double slack) {
    const Vec3 normal = glm::abs(glm::cross(s[1] - s[0], s[2] - s[0]));
    const int drop = greatest_axis(normal);
    const auto flat = [&](Vec3 x) { return Vec2(x[(drop + 1) % 3], x[(drop + 2) % 3]); };
    const auto parts = [&](const TrianglePositions& a, const TrianglePositions& b) {
        const int turn = sign(orientation(flat(a[0]), flat(a[1]), flat(a[2])));
        if (turn == 0) return true;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec2 from = flat(a[k]), to = flat(a[(k + 1) % 3]);
            bool beyond = true;
            for (const Vec3& x : b)
                beyond &= turn * sign(orientation(from, to, flat(x)), slack, glm::distance(from, to)) <= 0;
            if (beyond) return true;
        }
        return false;
    };
    return !parts(s, t) && !parts(t, s);
}

// The interval in which the triangle meets the plane through the other triangle, measured along a direction in both
// planes.
std::array<double, 2> along_line(const TrianglePositions& t, const TrianglePositions& plane, Vec3 direction) {
    const Vec3 normal = glm::cross(plane[1] - plane[0], plane[2] - plane[0]);
    std::array<double, 2> found{infinity, -infinity};
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 a = t[k], b = t[(k + 1) % 3];
        const double ha = glm::dot(normal, a - plane[0]), hb = glm::dot(normal, b - plane[0]);
        if ((ha > 0 && hb > 0) || (ha < 0 && hb < 0) || ha == hb) continue;
        const double at = glm::dot(direction, a + (b - a) * (ha / (ha - hb)) - plane[0]);
        found = {std::min(found[0], at), std::max(found[1], at)};
    }
    return found;
}

// Whether two triangles, each of which reaches through the other's plane, have a piece of the planes' common line in
// common. That happens without an edge that pierces where they meet along a line from edge to edge.
bool share_a_line(const TrianglePositions& a, const TrianglePositions& b, double slack) {
    constexpr double least_share = 1e-6;  // relative to the shorter piece, and to the sine of the planes' angle
    const Vec3 na = glm::cross(a[1] - a[0], a[2] - a[0]), nb = glm::cross(b[1] - b[0], b[2] - b[0]);
    const Vec3 line = glm::cross(na, nb);
    const double length = glm::length(line);
    if (!(length > least_share * glm::length(na) * glm::length(nb))) return false;
    const auto from_a = [&](const TrianglePositions& t, const TrianglePositions& plane) {
        auto piece = along_line(t, plane, line / length);
        const double shift = glm::dot(line / length, plane[0] - a[0]);
        return std::array{piece[0] + shift, piece[1] + shift};
    };
    const auto p = from_a(a, b), q = from_a(b, a);
    const double common = std::min(p[1], q[1]) - std::max(p[0], q[0]);
    return common > std::max(4 * slack, least_share * std::min(p[1] - p[0], q[1] - q[0]));
}

}  // namespace

bool triangles_cross(const Mesh& mesh, const Triangle& s, const Triangle& t, double slack) {
    TrianglePositions a, b;
    std::array<bool, 3> a_shared{}, b_shared{};
    int shared = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        a[k] = mesh.positions[s.vertex[k]];
        b[k] = mesh.positions[t.vertex[k]];
        for (std::size_t l = 0; l < 3; ++l) {
            if (t.vertex[l] != s.vertex[k]) continue;
            ++shared;
            a_shared[k] = b_shared[l] = true;
        }
    }
    // Triangles that share an edge, or of which one does not reach through the other's plane, can only overlap in one
    // plane.
    const auto reaches_through = [slack](const TrianglePositions& plane, const TrianglePositions& of,
                                         const std::array<bool, 3>& on_it, std::array<int, 3>& sides) {
        const Sides sides_of_plane(plane, slack);
        for (std::size_t k = 0; k < 3; ++k) sides[k] = on_it[k] ? 0 : sides_of_plane.of(of[k]);
        return std::ranges::min(sides) < 0 && std::ranges::max(sides) > 0;
    };
    std::array<int, 3> sides_of_a{}, sides_of_b{};
    if (!reaches_through(a, b, b_shared, sides_of_b)) return sides_of_b == std::array{0, 0, 0} && overlap(a, b, slack);
    if (shared >= 2 || !reaches_through(b, a, a_shared, sides_of_a)) return false;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t n = (k + 1) % 3;
        if (pierces(a[k], sides_of_a[k], a[n], sides_of_a[n], b, slack) ||
            pierces(b[k], sides_of_b[k], b[n], sides_of_b[n], a, slack))
            return true;
    }
    return shared == 0 && share_a_line(a, b, slack);
}

}  // namespace deburr
