// Pairs the triangles of a closed mesh at their edges, also where more than two meet in one edge.
#include <algorithm>
#include <span>
#include <utility>

#include "bounds/closed_mesh.hpp"
#include "bounds/half_edges.hpp"

namespace deburr {
namespace {

using HalfEdges = std::span<const HalfEdge>;
using Pairs = std::vector<std::pair<const HalfEdge*, const HalfEdge*>>;

// The number of half-edges that run up less that of those that run down; 0 where the edge is closed.
int balance_of(HalfEdges edge) {
    int balance = 0;
    for (const HalfEdge& e : edge) balance += e.up ? 1 : -1;
    return balance;
}

// The half-edges of one edge, sorted by their triangles' angle around it, seen from `lo` to `hi`.
std::vector<const HalfEdge*> in_order_around(const ClosedMesh& mesh, HalfEdges edge) {
    const Vec3 lo = mesh.vertices()[edge[0].lo], along = glm::normalize(mesh.vertices()[edge[0].hi] - lo);
    Vec3 x = glm::cross(along, std::abs(along.x) < 0.6 ? Vec3(1, 0, 0) : Vec3(0, 1, 0));
    x = glm::normalize(x);
    const Vec3 y = glm::cross(along, x);
    std::vector<std::pair<double, const HalfEdge*>> angles;
    for (const HalfEdge& e : edge) {
        const Vec3 d = mesh.corner(e.triangle, (e.k + 2) % 3) - lo;
        angles.push_back({std::atan2(glm::dot(d, y), glm::dot(d, x)), &e});
    }
    std::sort(angles.begin(), angles.end());
    std::vector<const HalfEdge*> around;
    for (const auto& [angle, e] : angles) around.push_back(e);
    return around;
}

// Pairs the triangles around an edge. Looking from lo to hi, the solid lies between a triangle whose half-edge runs up
// and the next one, clockwise, whose half-edge runs down. So, as brackets are matched, a stack of those that run up
// pairs each with the nearest behind it that runs down.
void pair_around(const std::vector<const HalfEdge*>& around, Pairs& pairs) {
    std::vector<std::size_t> stack;
    std::vector<char> paired(around.size(), false);
    for (std::size_t step = 0; step < 2 * around.size(); ++step) {
        const std::size_t at = (2 * around.size() - 1 - step) % around.size();
        if (paired[at]) continue;
        if (around[at]->up) {
            if (step < around.size()) stack.push_back(at);
        } else if (!stack.empty()) {
            pairs.push_back({around[stack.back()], around[at]});
            paired[at] = paired[stack.back()] = true;
            stack.pop_back();
        }
    }
}

}  // namespace

void ClosedMesh::find_neighbours() {
    const std::vector<HalfEdge> all = sorted_half_edges(triangles_);
    Pairs pairs;
    std::size_t open = 0;
    Vec3 place(0.0);
    each_edge(all, [&](HalfEdges edge) {
        if (balance_of(edge) != 0) {
            if (open++ == 0) place = 0.5 * (vertices_[edge[0].lo] + vertices_[edge[0].hi]);
        } else if (edge.size() == 2) {
            pairs.push_back({&edge[0], &edge[1]});
        } else {
            pair_around(in_order_around(*this, edge), pairs);
        }
    });
    if (open > 0) throw NotClosed(open, place);
    neighbours_.resize(triangles_.size());
    edges_.resize(triangles_.size());
    for (int id = 0; const auto& [a, b] : pairs) {
        neighbours_[a->triangle][a->k] = {b->triangle, b->k};
        neighbours_[b->triangle][b->k] = {a->triangle, a->k};
        edges_[a->triangle][a->k] = edges_[b->triangle][b->k] = id++;
    }
}

}  // namespace deburr
