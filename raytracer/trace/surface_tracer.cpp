#include "raytracer/trace/surface_tracer.hpp"

#include <algorithm>

#include "raytracer/trace/packet_search.hpp"

namespace deburr {
namespace {

struct Visit {
    int node;
    double t0, t1;
};

// Calls cell(number, t) for the cells that the ray passes within [t0, t1], in order, t being where it
// enters them, until one returns true.
template <class OnCell>
void traverse(const BspTree& tree, const Ray& ray, double t0, double t1, OnCell on_cell) {
    Visit stack[128];
    int top = 0;
    Visit now{0, t0, t1};
    for (;;) {
        const BspNode& node = tree.nodes[std::size_t(now.node)];
        if (node.axis == 3) {
            if (on_cell(std::size_t(node.child), now.t0) || top == 0) return;
            now = stack[--top];
            continue;
        }
        const double o = ray.origin[node.axis], d = ray.direction[node.axis];
        if (d == 0) {
            now.node = node.child + (o > node.split);
            continue;
        }
        const int near = node.child + (d < 0), far = node.child + (d > 0);
        const double t = (node.split - o) / d;
        if (t >= now.t1) {
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

template <bool Any>
[[gnu::always_inline]] inline bool BspTracer::search(SurfaceSearch<Any>& search) const {
    search.look_at_planes();
    if (search.enough()) return true;
    const Ray& ray = search.ray();
    // What is no number would be let into empty boxes.
    const Vec3 sum = ray.origin + ray.direction;
    if (!(sum == sum)) return false;
    const BoxSpan span = span_in(around_, ray.origin, search.inverse(), 0, search.end());
    const bool meets = !around_.empty() && span.lo <= span.hi;
    if (!bounded_) {
        walk(search, search.begin(), meets ? span.lo : search.end());
        if (search.enough() || (search.found() && search.end() < span.lo)) return true;
    }
    if (!meets) return search.found();
    const auto look = [&](std::uint32_t i) {
        search.look_at(i);
        return search.enough() ? -1.0 : search.end();
    };
    if (!embree_)
        boxes_.visit(ray.origin, ray.direction, search.inverse(), span.lo, span.hi, look);
    else
        embree_->visit(ray.origin, ray.direction, span.lo, span.hi,
                       Any ? EmbreeBoxes::Order::any : EmbreeBoxes::Order::nearest_first, look);
    if (!bounded_ && !search.enough() && search.end() > span.hi) walk(search, span.hi, search.end());
    return search.found();
}

template <bool Any>
void BspTracer::walk(SurfaceSearch<Any>& search, double t0, double t1) const {
    const BspTree& tree = trees_[0];  // whose pieces are the first
    traverse(tree, search.ray(), t0, t1, [&](std::size_t number, double from) {
        // What is crossed within rounding of a wall may be found in either cell.
        if (search.enough() || from - search.rounding(from) > search.end()) return true;
        const BspCell& cell = tree.cells[number];
        for (std::uint32_t i = cell.first; i < cell.first + cell.count; ++i) search.look_at(i);
        return false;
    });
}

FoundSurface BspTracer::find_nearby(const Ray& ray, double begin, double t_max, TraceCounters& counters,
                                    const Others* others, double end) const {
    SurfaceSearch<false> s(surfaces_, ray, t_max, end, counters, others, begin);
    return search(s) ? s.surface() : FoundSurface{};
}

bool BspTracer::any_nearby(const Ray& ray, double begin, double t_max, TraceCounters& counters,
                           const Others* others) const {
    SurfaceSearch<true> s(surfaces_, ray, t_max, t_max, counters, others, begin);
    return search(s);
}

// ---- rays from far away --------------------------------------------------------------------------

FoundSurface BspTracer::find_from_afar(const Ray& ray, double t_max, TraceCounters& counters, const Others* others,
                                       double end) const {
    const double start = vicinity_.start(ray);
    if (start == 0) return find_nearby(ray, 0, t_max, counters, others, end);
    const FarRay far(ray, start, t_max, surfaces_.scale);
    if (has_unbounded()) {
        const FoundSurface first = find_nearby(ray, 0, std::min(t_max, far.middle), counters, others, end);
        if (first.crossing.t < infinity) return first;
    }
    if (std::min(t_max, end) < far.middle) return {};
    FoundSurface found = find_nearby(far.moved, far.begin, far.t_max, counters, others, end - start);
    found.start = start;
    return found;
}

bool BspTracer::any_from_afar(const Ray& ray, double t_max, TraceCounters& counters, const Others* others) const {
    const double start = vicinity_.start(ray);
    if (start == 0) return any_nearby(ray, 0, t_max, counters, others);
    const FarRay far(ray, start, t_max, surfaces_.scale);
    if (has_unbounded() && any_nearby(ray, 0, std::min(t_max, far.middle), counters, others)) return true;
    return t_max >= far.middle && any_nearby(far.moved, far.begin, far.t_max, counters, others);
}

// ---- rays together -------------------------------------------------------------------------------

namespace {

// Fewer are led alone: together they gain nothing.
constexpr std::size_t fewest_together = 4;

}  // namespace

bool BspTracer::leads_together(std::size_t rays) const { return rays >= fewest_together && bounded_ && !embree_; }

// Those that begin elsewhere than at 0 are moved already.
double BspTracer::farthest(const SeveralRays& rays) const {
    return rays.begin.empty() ? vicinity_.farthest() : infinity;
}

void BspTracer::find(const SeveralRays& rays, FoundSurface* found, TraceCounters& counters,
                     const Others* others) const {
    if (!leads_together(rays.size())) {
        for (std::size_t k = 0; k < rays.size(); ++k)
            found[k] = find(rays.rays[k], rays.t_max[k], counters, others, rays.end[k]);
        return;
    }
    PacketSearch<false> packet(surfaces_, rays, counters, others, farthest(rays));
    if (packet.is_far()) return find_from_afar(rays, found, counters, others);
    packet.search(boxes_);
    for (int k = 0; k < int(rays.size()); ++k) found[k] = packet.surface(k);
}

Lanes BspTracer::any(const SeveralRays& rays, TraceCounters& counters, const Others* others) const {
    Lanes found = 0;
    if (!leads_together(rays.size())) {
        for (std::size_t k = 0; k < rays.size(); ++k)
            found |= Lanes(any(rays.rays[k], rays.t_max[k], counters, others)) << k;
        return found;
    }
    PacketSearch<true> packet(surfaces_, rays, counters, others, farthest(rays));
    if (packet.is_far()) return any_from_afar(rays, counters, others);
    packet.search(boxes_);
    return packet.any();
}

namespace {

// Rays that go on together beside the space: those from far away are moved.
struct RaysBeside {
    std::size_t count = 0;
    Ray rays[RayPacket::size];
    double t_max[RayPacket::size], end[RayPacket::size], begin[RayPacket::size], start[RayPacket::size];
    std::size_t number[RayPacket::size];  // among those that were asked for together

    /// on_the_way(number, until): whether a ray from far away is done with before it comes near.
    template <class OnTheWay>
    RaysBeside(const SeveralRays& all, const Vicinity& vicinity, double scale, OnTheWay on_the_way) {
        for (std::size_t k = 0; k < all.size(); ++k) {
            FarRay far(all.rays[k], vicinity.start(all.rays[k]), all.t_max[k], scale);
            if (far.start > 0 && on_the_way(k, far.middle)) continue;
            rays[count] = far.start > 0 ? far.moved : all.rays[k];
            t_max[count] = far.start > 0 ? far.t_max : all.t_max[k];
            end[count] = all.end[k] - far.start;
            begin[count] = far.start > 0 ? far.begin : 0;
            start[count] = far.start;
            number[count++] = k;
        }
    }
    SeveralRays several() const { return {{rays, count}, {t_max, count}, {end, count}, {begin, count}}; }
};

}  // namespace

void BspTracer::find_from_afar(const SeveralRays& rays, FoundSurface* found, TraceCounters& counters,
                               const Others* others) const {
    const RaysBeside beside(rays, vicinity_, surfaces_.scale, [&](std::size_t k, double middle) {
        if (!has_unbounded()) return false;
        found[k] = find_nearby(rays.rays[k], 0, std::min(rays.t_max[k], middle), counters, others, rays.end[k]);
        return found[k].crossing.t < infinity;
    });
    if (beside.count < fewest_together) {
        for (std::size_t i = 0; i < beside.count; ++i) {
            const std::size_t k = beside.number[i];
            found[k] = find(rays.rays[k], rays.t_max[k], counters, others, rays.end[k]);
        }
        return;
    }
    FoundSurface of_moved[RayPacket::size];
    find(beside.several(), of_moved, counters, others);
    for (std::size_t i = 0; i < beside.count; ++i) {
        found[beside.number[i]] = of_moved[i];
        found[beside.number[i]].start = beside.start[i];
    }
}

Lanes BspTracer::any_from_afar(const SeveralRays& rays, TraceCounters& counters, const Others* others) const {
    Lanes found = 0;
    const RaysBeside beside(rays, vicinity_, surfaces_.scale, [&](std::size_t k, double middle) {
        const bool any =
            has_unbounded() && any_nearby(rays.rays[k], 0, std::min(rays.t_max[k], middle), counters, others);
        found |= Lanes(any) << k;
        return any;
    });
    if (beside.count < fewest_together) {
        for (std::size_t i = 0; i < beside.count; ++i) {
            const std::size_t k = beside.number[i];
            found |= Lanes(any(rays.rays[k], rays.t_max[k], counters, others)) << k;
        }
        return found;
    }
    const Lanes of_moved = any(beside.several(), counters, others);
    for (std::size_t i = 0; i < beside.count; ++i) found |= (of_moved >> i & 1) << beside.number[i];
    return found;
}

// ---- construction --------------------------------------------------------------------------------

namespace {

// So many boxes are a single node of a BoxTree, and not worth a scene of Embree's.
constexpr std::size_t few = 4;

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

BspTracer::BspTracer(BspTree&& tree, Criterion criterion, Accel accel)
    : BspTracer(alone(std::move(tree)), {}, criterion, accel) {}

BspTracer::BspTracer(std::vector<NamedBsp> bsps, const std::vector<Box>& others, Criterion criterion, Accel accel) {
    Tolerances tolerances = bsps[0].tree.tolerances;
    double least_scale = infinity;  // of BSPs that hold anything
    for (const NamedBsp& bsp : bsps) {
        tolerances.scale = std::max(tolerances.scale, bsp.tree.tolerances.scale);
        if (!bsp.tree.locals.empty()) least_scale = std::min(least_scale, bsp.tree.tolerances.scale);
    }
    surfaces_.scale = tolerances.scale;
    Pieces &pieces = surfaces_.pieces, &planes = surfaces_.planes;
    pieces = planes = Pieces(tolerances, criterion);
    std::vector<Box> boxes;  // of pieces
    Box world;
    for (const Box& box : others) {
        world = hull(world, box);
        surfaces_.others.push_back(inflated(box, tolerances.margin()));
    }
    for (NamedBsp& bsp : bsps) {
        const auto name = [&](const LocalSolid& local) { return bsp.solids[std::size_t(local.solid())]; };
        for (LocalSolid& plane : bsp.tree.planes) {
            const int solid = name(plane);
            planes.add(std::move(plane), Box::everything(), solid);
        }
        const std::vector<Box> cells = cells_of_locals(bsp.tree);
        for (std::size_t i = 0; i < cells.size(); ++i) {
            LocalSolid& local = bsp.tree.locals[i];
            const Box around = intersection(cells[i], bsp.tree.boxes[std::size_t(local.solid())]);
            const int solid = name(local);
            pieces.add(std::move(local), around, solid);
            boxes.push_back(pieces.surface_box(boxes.size(), bsp.tree.tolerances.margin()));
            if (boxes.back().finite())
                world = hull(world, boxes.back());
            else
                bounded_ = false;
        }
    }
    BoxTree::Builder builder;
    std::vector<int> parts;
    std::vector<NumberedBox> items;
    std::uint32_t first = 0;
    for (NamedBsp& bsp : bsps) {
        parts.push_back(join_like(bsp.tree, builder, [&](std::uint32_t i) {
            const Box box = intersection(boxes[first + i], world);
            if (box.empty()) return BoxTree::Builder::nothing;
            items.push_back({first + i, box});
            return builder.item(first + i, box);
        }));
        first += std::uint32_t(bsp.tree.locals.size());
        bsp.tree.locals.clear();
        bsp.tree.planes.clear();
        const bool walked = trees_.empty() && !bounded_;
        if (!walked) bsp.tree.nodes = {};
        trees_.push_back(std::move(bsp.tree));
    }
    for (const Box& box : others) {
        items.push_back({first, box});
        parts.push_back(builder.item(first++, box));
    }
    for (const NumberedBox& item : items) around_ = hull(around_, item.box);
    // Rays that meet planes only are as exact as they can be.
    if (!around_.empty() || !bounded_) vicinity_ = Vicinity(around_, tolerances.scale, least_scale);
    if (accel == Accel::embree && items.size() > few)
        embree_.emplace(items);
    else
        boxes_ = BoxTree(builder, builder.join_by_area(std::move(parts)));
}

}  // namespace deburr
