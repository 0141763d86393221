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

}  // namespace

// `Any`: that there is a crossing is all that is asked.
template <bool Any>
class BspTracer::Finder {
public:
    Finder(const BspTracer& bsp, const Ray& ray, double t_max, TraceCounters& counters, const Others* others)
        : bsp_(bsp), ray_(ray), inverse_(reciprocal(ray.direction)), reach_(bsp.scale_ + largest(ray.origin)),
          end_(t_max), counters_(counters), others_(others) {}

    bool search() {
        for (std::size_t i = 0; i < bsp_.planes_.size(); ++i) look(bsp_.planes_, i, 0, end_);
        if (enough()) return true;
        const BoxSpan span = span_in(bsp_.boxes_.box(), ray_.origin, inverse_, 0, end_);
        const bool meets = !bsp_.boxes_.empty() && span.lo <= span.hi;
        if (!bsp_.bounded_) {
            walk(0, meets ? span.lo : end_);
            if (!meets || enough() || (found_ && end_ <= span.lo)) return found_;
        }
        if (!meets) return found_;
        bsp_.boxes_.visit(ray_.origin, ray_.direction, inverse_, span.lo, span.hi, [&](std::uint32_t i) {
            if (i < bsp_.pieces_.size()) look_in_cell(i);
            else look_at_other(i - std::uint32_t(bsp_.pieces_.size()));
            return enough() ? -1.0 : end_;
        });
        if (!bsp_.bounded_ && !enough() && end_ > span.hi) walk(span.hi, end_);
        return found_;
    }

    /// What was found.
    FoundSurface surface() const {
        if (!pieces_) return of_other_;
        return {{end_, pieces_->normal(piece_, crossing_, ray_.origin, ray_.direction), crossing_.material},
                solid_,
                rounding(end_) + crossing_.error};
    }

private:
    bool enough() const { return Any && found_; }

    // Where a ray begins among the numbers: a distance along it is rounded by this much.
    double rounding(double t) const { return 4 * epsilon * (reach_ + t); }

    void walk(double t0, double t1) {
        const double known = end_;
        const BspTree& tree = bsp_.trees_[0];  // whose pieces are the first
        traverse(tree, ray_, t0, t1, [&](std::size_t number) {
            const BspCell& cell = tree.cells[number];
            for (std::uint32_t i = cell.first; i < cell.first + cell.count; ++i) look_in_cell(i);
            return end_ < known || enough();
        });
    }

    void look_in_cell(std::uint32_t i) {
        const BoxSpan span = span_in(bsp_.pieces_[i].box, ray_.origin, inverse_, 0, end_);
        // Cells overlap by what their walls are rounded by: a surface in a wall belongs to both.
        const double pad = rounding(std::min(span.lo, span.hi));
        const double from = std::max(0.0, span.lo - pad), to = std::min(end_, span.hi + pad);
        if (from <= to) look(bsp_.pieces_, i, from, to);
    }

    // Of crossings at the same place, the solid with the lower number has it.
    bool is_better(double t, int solid) const { return t < end_ || (t == end_ && (!found_ || solid < solid_)); }

    void look(const Pieces& pieces, std::size_t i, double from, double to) {
        ++counters_.cells;
        const Piece& p = pieces[i];
        if (p.kind == Piece::Kind::plane) {
            const double t = pieces.plane_crossing(p, ray_.origin, ray_.direction);
            if (!(t >= from && t <= to && t < infinity)) return;
            ++counters_.flat_hits;
            if (Any || is_better(t, p.solid)) take(t, p.solid, &pieces, i, p.material);
        } else if (p.kind == Piece::Kind::convex) {
            if constexpr (Any) {
                found_ = found_ || pieces.crosses_convex(p, ray_.origin, ray_.direction, from, to, counters_);
            } else {
                const ConvexCrossing c = pieces.convex_crossing(p, ray_.origin, ray_.direction, from, to, counters_);
                if (!(c.t < infinity) || !is_better(c.t, p.solid)) return;
                take(c.t, p.solid, &pieces, i, p.material);
                crossing_.convex = c;
            }
        } else {
            const SurfaceCrossing c = pieces.general_crossing(p, ray_.origin, ray_.direction, from, to, Any, counters_);
            if (!(c.t < infinity) || !(Any || is_better(c.t, p.solid))) return;
            take(c.t, p.solid, &pieces, i, c.material);
            crossing_.normal = c.normal;
            crossing_.error = c.error;
        }
    }

    void take(double t, int solid, const Pieces* pieces, std::size_t piece, int material) {
        found_ = true;
        end_ = t;
        solid_ = solid;
        pieces_ = pieces;
        piece_ = piece;
        crossing_.t = t;
        crossing_.material = material;
        crossing_.error = 0;
    }

    void look_at_other(std::uint32_t i) {
        if constexpr (Any) {
            found_ = others_->any(i, ray_, end_, counters_);
        } else {
            const FoundSurface found = others_->find(i, ray_, end_, counters_);
            const double t = found.crossing.t;
            if (!(t < infinity) || !is_better(t, found.solid)) return;
            take(t, found.solid, nullptr, 0, 0);
            of_other_ = found;
        }
    }

    const BspTracer& bsp_;
    const Ray& ray_;
    Vec3 inverse_;
    double reach_;  // of coordinates that are added
    double end_;  // nothing counts beyond
    TraceCounters& counters_;
    const Others* others_;
    // What was found, as yet without its normal.
    bool found_ = false;
    int solid_ = -1;
    const Pieces* pieces_ = nullptr;  // null: it is another's
    std::size_t piece_ = 0;
    PieceCrossing crossing_;
    FoundSurface of_other_;
};

FoundSurface BspTracer::find(const Ray& ray, double t_max, TraceCounters& counters, const Others* others) const {
    Finder<false> finder(*this, ray, t_max, counters, others);
    return finder.search() ? finder.surface() : FoundSurface{};
}

bool BspTracer::any(const Ray& ray, double t_max, TraceCounters& counters, const Others* others) const {
    return Finder<true>(*this, ray, t_max, counters, others).search();
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
