#include "raytracer/bsp.hpp"

#include <algorithm>

#include "raytracer/bsp_tree.hpp"

namespace deburr {

struct ImplicitTracer::Bsp {
    BspTree tree;
    Criterion criterion;
};

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

// First crossing along the ray in [0, t_max].
struct Found {
    SurfaceCrossing crossing;
    int solid = -1;
};

Found find(const BspTree& tree, Criterion criterion, const Ray& ray, double t_max, bool any,
           TraceCounters& counters) {
    CrossingScratch& memory = scratch();
    memory.criterion = criterion;
    memory.counters = {};
    Found best;
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
                best = {c, local.solid()};
                if (any) return true;
            }
        }
        return best.crossing.t < infinity;
    });
    counters.flat_hits += memory.counters.flat;
    counters.segments += memory.counters.roots.segments;
    counters.splits += memory.counters.roots.splits;
    counters.evaluations += memory.counters.roots.evaluations;
    return best;
}

}  // namespace

ImplicitTracer::ImplicitTracer(const std::vector<Solid>& solids, Criterion criterion)
    : bsp_(new Bsp{build_bsp(solids), criterion}) {}

ImplicitTracer::~ImplicitTracer() = default;

Hit ImplicitTracer::first_hit(const Ray& ray, double t_max, TraceCounters& counters) const {
    ++counters.rays;
    const Found found = find(bsp_->tree, bsp_->criterion, ray, t_max, false, counters);
    if (!(found.crossing.t < infinity)) return {};
    Hit hit;
    hit.t = found.crossing.t;
    hit.position = ray.origin + ray.direction * hit.t;
    hit.normal = found.crossing.normal;
    hit.solid = found.solid;
    hit.material = found.crossing.material;
    // Far beyond the error of the position, far below anything to be seen.
    hit.offset = 128 * rounding(bsp_->tree, ray, hit.t);
    return hit;
}

bool ImplicitTracer::occluded(const Ray& ray, double t_max, TraceCounters& counters) const {
    ++counters.shadow_rays;
    return find(bsp_->tree, bsp_->criterion, ray, t_max, true, counters).crossing.t < infinity;
}

BspStatistics ImplicitTracer::statistics() const {
    const BspTree& tree = bsp_->tree;
    BspStatistics s;
    s.cells = tree.cells.size();
    s.half_spaces = tree.half_spaces;
    s.depth = tree.depth;
    std::size_t local = 0;
    for (const BspCell& cell : tree.cells) {
        bool flat = cell.count > 0;
        for (std::uint32_t i = cell.first; i < cell.first + cell.count; ++i) {
            local += tree.locals[i].half_spaces();
            flat &= tree.locals[i].is_flat();
        }
        s.empty_cells += cell.count == 0;
        s.flat_cells += flat;
    }
    if (s.cells > s.empty_cells) s.mean_local_half_spaces = double(local) / double(s.cells - s.empty_cells);
    return s;
}

}  // namespace deburr
