#include "raytracer/bsp_trace.hpp"

#include <algorithm>

namespace deburr {

namespace {

struct Visit {
    int node;
    double t0, t1;
};

// Calls cell(number, t0, t1) for the cells that the ray passes within [0, t_max], in order, until
// one returns true.
template <class OnCell>
bool traverse(const BspTree& tree, const Ray& ray, double t_max, OnCell on_cell) {
    Visit stack[128];
    int top = 0;
    Visit now{0, 0, t_max};
    for (;;) {
        const BspNode& node = tree.nodes[std::size_t(now.node)];
        if (node.axis == 3) {
            if (on_cell(std::size_t(node.child), now.t0, now.t1)) return true;
            if (top == 0) return false;
            now = stack[--top];
            continue;
        }
        const double o = ray.origin[node.axis], d = ray.direction[node.axis];
        const bool upper = o > node.split || (o == node.split && d > 0);
        const int near = node.child + upper, far = node.child + !upper;
        const double t = (node.split - o) / d;  // NaN or not positive: the plane is never reached
        if (!(t > 0) || t >= now.t1) {
            now.node = near;
        } else if (t <= now.t0) {
            now.node = far;
        } else {
            stack[top++] = {far, t, now.t1};
            now = {near, now.t0, t};
        }
    }
}

double largest(Vec3 v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

// Where a ray begins among the numbers: a distance along it is rounded by this much.
double rounding(const BspTree& tree, const Ray& ray, double t) {
    return 4 * epsilon * (tree.tolerances.scale + largest(ray.origin) + t);
}

CrossingScratch& scratch() {
    thread_local CrossingScratch memory;
    return memory;
}

}  // namespace

FoundSurface find_surface(const BspTree& tree, Criterion criterion, const Ray& ray, double t_max, bool any,
                          TraceCounters& counters) {
    CrossingScratch& memory = scratch();
    memory.criterion = criterion;
    memory.counters = {};
    FoundSurface best;
    traverse(tree, ray, t_max, [&](std::size_t number, double t0, double t1) {
        ++counters.cells;
        const BspCell& cell = tree.cells[number];
        if (cell.count == 0) return false;
        // Cells overlap by what their walls are rounded by: a surface in a wall belongs to both.
        const double pad = t1 < infinity ? rounding(tree, ray, t1) : 0;
        const double from = std::max(0.0, t0 - pad), to = std::min(t_max, t1 + pad);
        for (std::uint32_t i = cell.first; i < cell.first + cell.count; ++i) {
            const LocalSolid& local = tree.locals[i];
            const SurfaceCrossing c = local.first_crossing(ray.origin, ray.direction, from,
                                                           std::min(to, best.crossing.t), memory);
            if (c.t < best.crossing.t) {
                best = {c, local.solid(), 0};
                if (any) return true;
            }
        }
        return best.crossing.t < infinity;
    });
    counters.flat_hits += memory.counters.flat;
    counters.segments += memory.counters.roots.segments;
    counters.splits += memory.counters.roots.splits;
    counters.evaluations += memory.counters.roots.evaluations;
    if (best.crossing.t < infinity) best.error = rounding(tree, ray, best.crossing.t) + best.crossing.error;
    return best;
}

}  // namespace deburr
