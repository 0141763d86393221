#include "raytracer/bsp_trace.hpp"

#include <algorithm>

namespace deburr {
namespace {

struct Visit {
    int node;
    double t0, t1;
};

// Calls cell(number) for the cells that the ray passes within [t0, t1], in order, until one returns
// true.
template <class OnCell>
bool traverse(const BspTree& tree, const Ray& ray, double t0, double t1, OnCell on_cell) {
    Visit stack[128];
    int top = 0;
    Visit now{0, t0, t1};
    for (;;) {
        const BspNode& node = tree.nodes[std::size_t(now.node)];
        if (node.axis == 3) {
            if (on_cell(std::size_t(node.child))) return true;
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

// First crossing along the ray, as yet without its normal.
struct Found {
    PieceCrossing crossing;
    int solid = -1;
    const Pieces* pieces = nullptr;  // null: of another
    std::size_t piece = 0;
};

}  // namespace

// Where a ray begins among the numbers: a distance along it is rounded by this much.
double BspTracer::rounding(const Ray& ray, double t) const {
    return 4 * epsilon * (scale_ + largest(ray.origin) + t);
}

class BspTracer::Finder {
public:
    Finder(const BspTracer& bsp, const Ray& ray, double t_max, bool any, TraceCounters& counters, const Others* others)
        : bsp_(bsp), ray_(ray), inverse_(reciprocal(ray.direction)), t_max_(t_max), any_(any), counters_(counters), others_(others) {}

    FoundSurface run() {
        search();
        const double t = best_.crossing.t;
        if (!(t < infinity)) return {};
        if (!best_.pieces) return of_other_;
        FoundSurface to{{t, Vec3(0.0), best_.crossing.material}, best_.solid, 0};
        if (any_) return to;
        to.crossing.normal = best_.pieces->normal(best_.piece, best_.crossing, ray_.origin, ray_.direction);
        to.error = bsp_.rounding(ray_, t) + best_.crossing.error;
        return to;
    }

private:
    bool enough() const { return any_ && best_.crossing.t < infinity; }
    double end() const { return std::min(t_max_, best_.crossing.t); }

    void search() {
        for (std::size_t i = 0; i < bsp_.planes_.size(); ++i) look(bsp_.planes_, i, 0, end());
        if (enough()) return;
        const BoxSpan span = span_in(bsp_.boxes_.box(), ray_.origin, inverse_, 0, end());
        const bool meets = span.lo <= span.hi;
        if (!bsp_.bounded_) {
            walk(0, meets ? span.lo : end());
            if (!meets || enough() || best_.crossing.t <= span.lo) return;
        }
        if (!meets) return;
        bsp_.boxes_.visit(ray_.origin, ray_.direction, span.lo, span.hi, [&](std::uint32_t i) {
            if (i < bsp_.pieces_.size()) look_in_cell(i);
            else look_at_other(i - std::uint32_t(bsp_.pieces_.size()));
            return enough() ? -1.0 : best_.crossing.t;
        });
        if (!bsp_.bounded_ && !enough() && best_.crossing.t > span.hi) walk(span.hi, end());
    }

    void walk(double t0, double t1) {
        const double known = best_.crossing.t;
        const BspTree& tree = bsp_.trees_[0];  // whose pieces are the first
        traverse(tree, ray_, t0, t1, [&](std::size_t number) {
            const BspCell& cell = tree.cells[number];
            for (std::uint32_t i = cell.first; i < cell.first + cell.count; ++i) look_in_cell(i);
            return best_.crossing.t < known;
        });
    }

    void look_in_cell(std::uint32_t i) {
        const BoxSpan span = span_in(bsp_.pieces_[i].box, ray_.origin, inverse_, 0, end());
        // Cells overlap by what their walls are rounded by: a surface in a wall belongs to both.
        const double pad = bsp_.rounding(ray_, std::min(span.lo, span.hi));
        const double from = std::max(0.0, span.lo - pad), to = std::min(end(), span.hi + pad);
        if (from <= to) look(bsp_.pieces_, i, from, to);
    }

    // Of crossings at the same place, the solid with the lower number has it.
    bool is_better(double t, int solid) const {
        return t < best_.crossing.t || (t == best_.crossing.t && t < infinity && solid < best_.solid);
    }

    void look(const Pieces& pieces, std::size_t i, double from, double to) {
        ++counters_.cells;
        const PieceCrossing c = pieces.crossing(i, ray_.origin, ray_.direction, from, to, any_, counters_);
        const int solid = pieces[i].solid;
        if (is_better(c.t, solid)) best_ = {c, solid, &pieces, i};
    }

    void look_at_other(std::uint32_t i) {
        const FoundSurface found = others_->find(i, ray_, end(), any_, counters_);
        if (!is_better(found.crossing.t, found.solid)) return;
        best_ = {};
        best_.crossing.t = found.crossing.t;
        best_.solid = found.solid;
        of_other_ = found;
    }

    const BspTracer& bsp_;
    const Ray& ray_;
    Vec3 inverse_;
    double t_max_;
    bool any_;
    TraceCounters& counters_;
    const Others* others_;
    Found best_;
    FoundSurface of_other_;
};

FoundSurface BspTracer::find(const Ray& ray, double t_max, bool any, TraceCounters& counters, const Others* others) const {
    return Finder(*this, ray, t_max, any, counters, others).run();
}

// ---- construction --------------------------------------------------------------------------------

namespace {

// The cells, by the places of what is in them.
std::vector<Box> cells_of_locals(const BspTree& tree) {
    std::vector<Box> of(tree.locals.size());
    // Children come after their parents.
    std::vector<Box> cell(tree.nodes.size(), Box::everything());
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        const BspNode& n = tree.nodes[i];
        if (n.axis == 3) {
            const BspCell& c = tree.cells[std::size_t(n.child)];
            std::fill_n(of.begin() + c.first, c.count, cell[i]);
            continue;
        }
        Box &lower = cell[std::size_t(n.child)], &upper = cell[std::size_t(n.child) + 1];
        lower = upper = cell[i];
        lower.hi[n.axis] = upper.lo[n.axis] = n.split;
    }
    return of;
}

// As the BSP has them; item(place) makes one.
template <class Item>
int join_like(const BspTree& tree, BoxTree::Builder& builder, Item item) {
    std::vector<int> part(tree.nodes.size(), BoxTree::Builder::nothing);
    const auto list = [&](auto&& self, std::uint32_t first, std::uint32_t last) -> int {
        if (first == last) return BoxTree::Builder::nothing;
        if (last - first == 1) return item(first);
        const std::uint32_t middle = first + (last - first) / 2;
        const int a = self(self, first, middle), b = self(self, middle, last);
        return builder.join(a, b);
    };
    for (std::size_t i = tree.nodes.size(); i-- > 0;) {
        const BspNode& n = tree.nodes[i];
        if (n.axis == 3) {
            const BspCell& c = tree.cells[std::size_t(n.child)];
            part[i] = list(list, c.first, c.first + c.count);
        } else {
            part[i] = builder.join(part[std::size_t(n.child)], part[std::size_t(n.child) + 1]);
        }
    }
    return part[0];
}

std::vector<NamedBsp> alone(BspTree&& tree) {
    std::vector<NamedBsp> all(1);
    for (std::size_t i = 0; i < tree.boxes.size(); ++i) all[0].solids.push_back(int(i));
    all[0].tree = std::move(tree);
    return all;
}

}  // namespace

BspTracer::BspTracer(BspTree&& tree, Criterion criterion) : BspTracer(alone(std::move(tree)), {}, criterion) {}

BspTracer::BspTracer(std::vector<NamedBsp> bsps, const std::vector<Box>& others, Criterion criterion) {
    Tolerances tolerances = bsps[0].tree.tolerances;
    for (const NamedBsp& bsp : bsps) tolerances.scale = std::max(tolerances.scale, bsp.tree.tolerances.scale);
    scale_ = tolerances.scale;
    pieces_ = planes_ = Pieces(tolerances, criterion);
    std::vector<Box> boxes;  // of pieces
    Box world;
    for (const Box& box : others) world = hull(world, box);
    for (NamedBsp& bsp : bsps) {
        const auto name = [&](const LocalSolid& local) { return bsp.solids[std::size_t(local.solid())]; };
        for (LocalSolid& plane : bsp.tree.planes) {
            const int solid = name(plane);
            planes_.add(std::move(plane), Box::everything(), solid);
        }
        const std::vector<Box> cells = cells_of_locals(bsp.tree);
        for (std::size_t i = 0; i < cells.size(); ++i) {
            LocalSolid& local = bsp.tree.locals[i];
            const Box around = intersection(cells[i], bsp.tree.boxes[std::size_t(local.solid())]);
            const int solid = name(local);
            pieces_.add(std::move(local), around, solid);
            boxes.push_back(pieces_.surface_box(boxes.size(), bsp.tree.tolerances.margin()));
            if (boxes.back().finite()) world = hull(world, boxes.back());
            else bounded_ = false;
        }
    }
    BoxTree::Builder builder;
    std::vector<int> parts;
    std::uint32_t first = 0;
    for (NamedBsp& bsp : bsps) {
        parts.push_back(join_like(bsp.tree, builder, [&](std::uint32_t i) {
            const Box box = intersection(boxes[first + i], world);
            return box.empty() ? BoxTree::Builder::nothing : builder.item(first + i, box);
        }));
        first += std::uint32_t(bsp.tree.locals.size());
        bsp.tree.locals.clear();
        bsp.tree.planes.clear();
        const bool walked = trees_.empty() && !bounded_;
        if (!walked) bsp.tree.nodes = {};
        trees_.push_back(std::move(bsp.tree));
    }
    for (const Box& box : others) parts.push_back(builder.item(first++, box));
    boxes_ = BoxTree(builder, builder.join_by_area(std::move(parts)));
}

}  // namespace deburr
