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

double largest(Vec3 v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

// First crossing along the ray, as yet without its normal.
struct Found {
    PieceCrossing crossing;
    int solid = -1;
    const Pieces* pieces = nullptr;
    std::size_t piece = 0;
};

}  // namespace

// Where a ray begins among the numbers: a distance along it is rounded by this much.
double BspTracer::rounding(const Ray& ray, double t) const {
    return 4 * epsilon * (tree_.tolerances.scale + largest(ray.origin) + t);
}

class BspTracer::Finder {
public:
    Finder(const BspTracer& bsp, const Ray& ray, double t_max, bool any, TraceCounters& counters)
        : bsp_(bsp), ray_(ray), inverse_(reciprocal(ray.direction)), t_max_(t_max), any_(any), counters_(counters) {}

    Found run() {
        for (std::size_t i = 0; i < bsp_.planes_.size(); ++i) look(bsp_.planes_, i, 0, end());
        if (enough()) return best_;
        const Box& box = bsp_.boxes_.box();
        const BoxSpan span = span_in(box, ray_.origin, inverse_, 0, end());
        const bool meets = span.lo <= span.hi;
        if (!bsp_.bounded_) {
            walk(0, meets ? span.lo : end());
            if (!meets || enough() || best_.crossing.t <= span.lo) return best_;
        }
        if (!meets) return best_;
        bsp_.boxes_.visit(ray_.origin, ray_.direction, span.lo, span.hi, [&](std::uint32_t i) {
            look_in_cell(i);
            return enough() ? -1.0 : best_.crossing.t;
        });
        if (!bsp_.bounded_ && !enough() && best_.crossing.t > span.hi) walk(span.hi, end());
        return best_;
    }

private:
    bool enough() const { return any_ && best_.crossing.t < infinity; }
    double end() const { return std::min(t_max_, best_.crossing.t); }

    void walk(double t0, double t1) {
        const double known = best_.crossing.t;
        traverse(bsp_.tree_, ray_, t0, t1, [&](std::size_t number) {
            const BspCell& cell = bsp_.tree_.cells[number];
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

    void look(const Pieces& pieces, std::size_t i, double from, double to) {
        ++counters_.cells;
        const PieceCrossing c = pieces.crossing(i, ray_.origin, ray_.direction, from, to, any_, counters_);
        const int solid = pieces[i].solid;
        if (c.t < best_.crossing.t || (c.t == best_.crossing.t && c.t < infinity && solid < best_.solid))
            best_ = {c, solid, &pieces, i};
    }

    const BspTracer& bsp_;
    const Ray& ray_;
    Vec3 inverse_;
    double t_max_;
    bool any_;
    TraceCounters& counters_;
    Found best_;
};

BspTracer::BspTracer(BspTree&& tree, Criterion criterion)
    : tree_(std::move(tree)), pieces_(tree_.tolerances, criterion), planes_(tree_.tolerances, criterion) {
    for (LocalSolid& plane : tree_.planes) planes_.add(std::move(plane), Box::everything());
    std::vector<Box> box_of(tree_.locals.size());
    // Children come after their parents.
    std::vector<Box> cell(tree_.nodes.size(), Box::everything());
    for (std::size_t i = 0; i < tree_.nodes.size(); ++i) {
        const BspNode& n = tree_.nodes[i];
        if (n.axis == 3) {
            const BspCell& c = tree_.cells[std::size_t(n.child)];
            std::fill_n(box_of.begin() + c.first, c.count, cell[i]);
            continue;
        }
        Box &lower = cell[std::size_t(n.child)], &upper = cell[std::size_t(n.child) + 1];
        lower = upper = cell[i];
        lower.hi[n.axis] = upper.lo[n.axis] = n.split;
    }
    Box world;
    for (std::size_t i = 0; i < tree_.locals.size(); ++i) {
        pieces_.add(std::move(tree_.locals[i]), box_of[i]);
        box_of[i] = pieces_.surface_box(i);
        if (box_of[i].finite()) world = hull(world, box_of[i]);
        else bounded_ = false;
    }
    BoxTree::Builder builder;
    std::vector<int> part(tree_.nodes.size(), BoxTree::Builder::nothing);
    const auto of_pieces = [&](auto&& self, std::uint32_t first, std::uint32_t last) -> int {
        if (first == last) return BoxTree::Builder::nothing;
        if (last - first > 1) {
            const std::uint32_t middle = first + (last - first) / 2;
            return builder.join(self(self, first, middle), self(self, middle, last));
        }
        const Box box = intersection(box_of[first], world);
        return box.empty() ? BoxTree::Builder::nothing : builder.item(first, box);
    };
    for (std::size_t i = tree_.nodes.size(); i-- > 0;) {
        const BspNode& n = tree_.nodes[i];
        if (n.axis == 3) {
            const BspCell& c = tree_.cells[std::size_t(n.child)];
            part[i] = of_pieces(of_pieces, c.first, c.first + c.count);
        } else {
            part[i] = builder.join(part[std::size_t(n.child)], part[std::size_t(n.child) + 1]);
        }
    }
    boxes_ = BoxTree(builder, part[0]);
    tree_.locals.clear();
    if (bounded_) {
        tree_.nodes.clear();
        tree_.nodes.shrink_to_fit();
    }
}

FoundSurface BspTracer::find(const Ray& ray, double t_max, bool any, TraceCounters& counters) const {
    const Found found = Finder(*this, ray, t_max, any, counters).run();
    const double t = found.crossing.t;
    if (!(t < infinity)) return {};
    FoundSurface to{{t, Vec3(0.0), found.crossing.material}, found.solid, 0};
    if (any) return to;
    to.crossing.normal = found.pieces->normal(found.piece, found.crossing, ray.origin, ray.direction);
    to.error = rounding(ray, t) + found.crossing.error;
    return to;
}

}  // namespace deburr
