#include "bounds/closed_mesh.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <string>
#include <utility>

namespace deburr {

NotClosed::NotClosed(std::size_t open_edges, Vec3 at)
    : std::invalid_argument("the mesh is not closed: " + std::to_string(open_edges) + " open edges"),
      count(open_edges),
      place(at) {}

namespace {

double angle_between(Vec3 a, Vec3 b) { return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)); }

}  // namespace

ClosedMesh::ClosedMesh(std::vector<Vec3> vertices, std::vector<Corners> triangles)
    : vertices_(std::move(vertices)), triangles_(std::move(triangles)) {
    drop_degenerate();
    find_planes();
    find_neighbours();
    join_planes();
    vertex_normals_.assign(vertices_.size(), Vec3(0.0));
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
        Box box;
        for (int k = 0; k < 3; ++k) {
            const Vec3 x = corner(int(t), k), a = corner(int(t), (k + 1) % 3) - x, b = corner(int(t), (k + 2) % 3) - x;
            box = hull(box, Box{x, x});
            vertex_normals_[triangles_[t][k]] += angle_between(a, b) * planes_[t].normal;
        }
        const Vec3 center = 0.5 * (box.lo + box.hi);
        double square = 0;
        for (int k = 0; k < 3; ++k) {
            const Vec3 d = corner(int(t), k) - center;
            square = std::max(square, glm::dot(d, d));
        }
        balls_.push_back({center, std::sqrt(square) * (1 + 4 * epsilon)});
        box_ = hull(box_, box);
    }
    order_.resize(triangles_.size());
    std::iota(order_.begin(), order_.end(), 0);
    if (!order_.empty()) build(0, int(order_.size()));
}

// Drops triangles without area, which bound nothing and have no normal: the triangle on the other side of the longest
// edge is split at the corner opposite to it.
void ClosedMesh::drop_degenerate() {
    const auto is_flat = [&](const Corners& t) {
        const Vec3 a = vertices_[t[1]] - vertices_[t[0]], b = vertices_[t[2]] - vertices_[t[0]];
        const double longest = std::max({glm::dot(a, a), glm::dot(b, b), glm::dot(a - b, a - b)});
        return !(glm::length(glm::cross(a, b)) > 1e-14 * longest);
    };
    std::erase_if(triangles_, [](const Corners& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
    for (std::size_t round = 0; round < 64; ++round) {
        if (std::none_of(triangles_.begin(), triangles_.end(), is_flat)) return;
        std::map<std::pair<int, int>, int> owner;  // triangle of each directed edge
        for (std::size_t t = 0; t < triangles_.size(); ++t) {
            for (int k = 0; k < 3; ++k) owner[{triangles_[t][k], triangles_[t][(k + 1) % 3]}] = int(t);
        }
        std::vector<char> touched(triangles_.size(), false), dropped(triangles_.size(), false);
        std::vector<Corners> added;
        for (std::size_t t = 0; t < triangles_.size(); ++t) {
            if (touched[t] || !is_flat(triangles_[t])) continue;
            int longest = 0;
            double most = -1;
            for (int k = 0; k < 3; ++k) {
                const double l = glm::distance(vertices_[triangles_[t][k]], vertices_[triangles_[t][(k + 1) % 3]]);
                if (l > most) most = l, longest = k;
            }
            const int a = triangles_[t][longest], b = triangles_[t][(longest + 1) % 3],
                      c = triangles_[t][(longest + 2) % 3];
            const auto at = owner.find({b, a});
            if (at == owner.end() || touched[at->second] || std::size_t(at->second) == t) continue;
            const Corners& other = triangles_[at->second];
            int d = -1;
            for (const int v : other)
                if (v != a && v != b) d = v;
            touched[t] = touched[at->second] = dropped[t] = dropped[at->second] = true;
            // The edge b → a of the other triangle becomes b → c and c → a.
            if (d == c) continue;  // both have the same corners, back to back
            added.push_back({b, c, d});
            added.push_back({c, a, d});
        }
        if (std::none_of(dropped.begin(), dropped.end(), [](char d) { return d; })) return;
        std::vector<Corners> left;
        for (std::size_t t = 0; t < triangles_.size(); ++t)
            if (!dropped[t]) left.push_back(triangles_[t]);
        left.insert(left.end(), added.begin(), added.end());
        triangles_ = std::move(left);
    }
}

void ClosedMesh::find_planes() {
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
        const Vec3 a = corner(int(t), 0), b = corner(int(t), 1), c = corner(int(t), 2);
        const Vec3 area = glm::cross(b - a, c - a);
        const double length = glm::length(area);
        Plane plane;
        plane.normal = length > 0 ? area / length : Vec3(0.0);
        plane.offset = glm::dot(plane.normal, (a + b + c) / 3.0);
        planes_.push_back(plane);
        areas_.push_back(0.5 * length);
        perimeters_.push_back(glm::distance(a, b) + glm::distance(b, c) + glm::distance(c, a));
    }
}

// Neighbours whose corners all lie in one plane, up to rounding, get that plane.
void ClosedMesh::join_planes() {
    double scale = 0;
    for (const Vec3& v : vertices_) scale = std::max(scale, largest(v));
    const double tolerance = 256 * epsilon * scale;
    std::vector<int> by_area(triangles_.size());
    std::iota(by_area.begin(), by_area.end(), 0);
    std::sort(by_area.begin(), by_area.end(),
              [&](int a, int b) { return areas_[a] != areas_[b] ? areas_[a] > areas_[b] : a < b; });
    // Starting from the largest triangle, whose plane is most exact, faces grow as far as corners lie in the plane.
    std::vector<char> done(triangles_.size(), false);
    std::vector<int> todo;
    int id = 0;
    for (const int seed : by_area) {
        if (done[seed]) continue;
        const Plane plane = planes_[seed];
        const auto lies_in = [&](int t) {
            if (glm::dot(planes_[t].normal, plane.normal) <= 0) return false;
            for (int k = 0; k < 3; ++k)
                if (std::abs(glm::dot(plane.normal, corner(t, k)) - plane.offset) > tolerance) return false;
            return true;
        };
        todo.assign(1, seed);
        done[seed] = true;
        while (!todo.empty()) {
            const int t = todo.back();
            todo.pop_back();
            planes_[t] = plane;
            planes_[t].id = id;
            for (int k = 0; k < 3; ++k) {
                const int next = neighbours_[t][k].triangle;
                if (done[next] || !lies_in(next)) continue;
                done[next] = true;
                todo.push_back(next);
            }
        }
        ++id;
    }
    plane_count_ = std::size_t(id);
}

double ClosedMesh::volume() const {
    double six = 0;
    const Vec3 o = box_.empty() ? Vec3(0.0) : 0.5 * (box_.lo + box_.hi);
    for (std::size_t t = 0; t < triangles_.size(); ++t)
        six += glm::dot(corner(int(t), 0) - o, glm::cross(corner(int(t), 1) - o, corner(int(t), 2) - o));
    return six / 6;
}

int ClosedMesh::build(int begin, int end) {
    constexpr int few = 4;
    const int at = int(nodes_.size());
    nodes_.emplace_back();
    Box box, centers;
    for (int i = begin; i < end; ++i) {
        for (int k = 0; k < 3; ++k) box = hull(box, Box{corner(order_[i], k), corner(order_[i], k)});
        const Vec3 c = balls_[order_[i]].center;
        centers = hull(centers, Box{c, c});
    }
    nodes_[at] = {box, begin, end, -1, -1};
    const Vec3 size = centers.hi - centers.lo;
    const int axis = greatest_axis(size);
    if (end - begin <= few || !(size[axis] > 0)) return at;
    const int middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, [&](int a, int b) {
        const double x = balls_[a].center[axis], y = balls_[b].center[axis];
        return x != y ? x < y : a < b;
    });
    const int left = build(begin, middle), right = build(middle, end);
    nodes_[at].left = left;
    nodes_[at].right = right;
    return at;
}

bool ClosedMesh::reaches(int t, const Box& box, double reach) const {
    const Vec3 center = 0.5 * (box.lo + box.hi), half = 0.5 * (box.hi - box.lo);
    const Vec3 x[3] = {corner(t, 0), corner(t, 1), corner(t, 2)};
    reach += 8 * epsilon * (largest(center) + largest(half) + largest(x[0]));
    double outside = 0;  // squared distance between the two boxes
    for (int k = 0; k < 3; ++k) {
        const double lo = std::min({x[0][k], x[1][k], x[2][k]}), hi = std::max({x[0][k], x[1][k], x[2][k]});
        const double gap = std::max(lo - box.hi[k], box.lo[k] - hi);
        if (gap > 0) outside += gap * gap;
    }
    if (outside > reach * reach) return false;
    const Plane& plane = planes_[t];
    const double above = glm::dot(plane.normal, center) - plane.offset;
    if (std::abs(above) > glm::dot(glm::abs(plane.normal), half) + reach) return false;
    for (int k = 0; k < 3; ++k) {
        const Vec3 outward = glm::cross(x[(k + 1) % 3] - x[k], plane.normal);
        const double length = glm::length(outward);
        if (!(length > 0)) continue;
        if (glm::dot(outward, center - x[k]) - glm::dot(glm::abs(outward), half) > reach * length) return false;
    }
    return true;
}

void ClosedMesh::near(const Box& box, double reach, std::vector<int>& found) const {
    const std::size_t before = found.size();
    visit_near(box, reach, [&](int t) {
        found.push_back(t);
        return true;
    });
    std::sort(found.begin() + std::ptrdiff_t(before), found.end());
}

/// Like visit_near(), but counts triangles of nodes that are within reach as a whole.
std::size_t ClosedMesh::count_near(const Box& box, double reach) const {
    if (nodes_.empty()) return 0;
    const Box wide = inflated(box, reach * (1 + 8 * epsilon));
    std::size_t count = 0;
    int stack[128], depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const Node& node = nodes_[stack[--depth]];
        if (intersection(node.box, wide).empty()) continue;
        if (node.left < 0 || (wide.contains(node.box.lo) && wide.contains(node.box.hi))) {
            count += std::size_t(node.end - node.begin);
            continue;
        }
        stack[depth++] = node.left;
        stack[depth++] = node.right;
    }
    return count;
}

// Offers the triangle's nearest point to x, by its Voronoi regions [Ericson, Real-Time Collision Detection, §5.1.5].
void ClosedMesh::look(Vec3 x, int t, Nearest& best) const {
    const Ball& ball = balls_[t];
    const double away = glm::distance(x, ball.center) - ball.radius;
    if (away > 0 && away * away > best.square) return;
    const Vec3 a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
    const Vec3 ab = b - a, ac = c - a, ax = x - a;
    const auto offer = [&](Vec3 point, int feature) {
        const Vec3 d = x - point;
        const double square = glm::dot(d, d);
        if (square < best.square) best = {square, t, feature, point};
    };
    const double d1 = glm::dot(ab, ax), d2 = glm::dot(ac, ax);
    if (d1 <= 0 && d2 <= 0) return offer(a, 0);
    const Vec3 bx = x - b;
    const double d3 = glm::dot(ab, bx), d4 = glm::dot(ac, bx);
    if (d3 >= 0 && d4 <= d3) return offer(b, 1);
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return offer(a + ab * (d1 / (d1 - d3)), 3);
    const Vec3 cx = x - c;
    const double d5 = glm::dot(ab, cx), d6 = glm::dot(ac, cx);
    if (d6 >= 0 && d5 <= d6) return offer(c, 2);
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return offer(a + ac * (d2 / (d2 - d6)), 5);
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return offer(b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))), 4);
    const double sum = va + vb + vc;
    offer(a + ab * (vb / sum) + ac * (vc / sum), 6);
}

Vec3 ClosedMesh::nearest(int triangle, Vec3 x) const {
    Nearest best;
    look(x, triangle, best);
    return best.point;
}

// By the sign of the pseudonormal at the nearest point [Bærentzen and Aanæs 2005]; at a corner it is weighted by
// angles.
bool ClosedMesh::is_inside(Vec3 x, const Nearest& nearest) const {
    if (nearest.triangle < 0) return false;
    Vec3 normal = planes_[nearest.triangle].normal;
    if (nearest.feature < 3)
        normal = vertex_normals_[triangles_[nearest.triangle][nearest.feature]];
    else if (nearest.feature < 6)
        normal += planes_[neighbours_[nearest.triangle][nearest.feature - 3].triangle].normal;
    return glm::dot(normal, x - nearest.point) <= 0;
}

bool ClosedMesh::contains(Vec3 x, std::span<const int> triangles, double reach) const {
    Nearest best;
    best.square = reach * reach;
    for (const int t : triangles) look(x, t, best);
    return best.triangle >= 0 ? is_inside(x, best) : contains(x);
}

bool ClosedMesh::contains(Vec3 x) const {
    Nearest best;
    const auto square_to = [&](const Box& box) {
        const Vec3 d = x - glm::clamp(x, box.lo, box.hi);
        return glm::dot(d, d);
    };
    std::pair<double, int> stack[128];
    int depth = 0;
    if (!nodes_.empty()) stack[depth++] = {square_to(nodes_[0].box), 0};
    while (depth > 0) {
        const auto [square, at] = stack[--depth];
        if (square > best.square) continue;
        const Node& node = nodes_[at];
        if (node.left < 0) {
            for (int i = node.begin; i < node.end; ++i) look(x, order_[i], best);
            continue;
        }
        std::pair<double, int> a{square_to(nodes_[node.left].box), node.left},
            b{square_to(nodes_[node.right].box), node.right};
        if (a.first < b.first) std::swap(a, b);
        stack[depth++] = a;
        stack[depth++] = b;
    }
    return is_inside(x, best);
}

ClosedMeshPtr transformed(const ClosedMesh& mesh, const Affine& map) {
    std::vector<Vec3> vertices;
    for (const Vec3& v : mesh.vertices()) vertices.push_back(map(v));
    std::vector<ClosedMesh::Corners> triangles = mesh.triangles();
    if (glm::determinant(map.linear) < 0)
        for (ClosedMesh::Corners& t : triangles) std::swap(t[1], t[2]);
    return std::make_shared<ClosedMesh>(std::move(vertices), std::move(triangles));
}

}  // namespace deburr
