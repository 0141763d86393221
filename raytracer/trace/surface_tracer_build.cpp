// Construction of a surface tracer: BSPs become one list of primitives, with one BVH around these and the instances.
#include <algorithm>
#include <utility>

#include "raytracer/trace/surface_tracer.hpp"

namespace deburr {
namespace {

// This many boxes fit into a single node of a Bvh8, and do not pay for a scene of Embree's.
constexpr std::size_t few = BoxNode::width;

// The cell of each local solid, by its index in BspTree::locals.
std::vector<Box> cells_of_locals(const BspTree& tree) {
    std::vector<Box> of(tree.locals.size());
    // Children come after their parents.
    std::vector<Box> cell(tree.nodes.size(), Box::everything());
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        const BspNode& n = tree.nodes[i];
        if (n.axis == 3) {
            const BspCell& c = tree.cells[n.child];
            std::fill_n(of.begin() + c.first, c.count, cell[i]);
            continue;
        }
        Box &lower = cell[n.child], &upper = cell[std::size_t(n.child) + 1];
        lower = upper = cell[i];
        lower.hi[n.axis] = upper.lo[n.axis] = n.split;
    }
    return of;
}

// Builds a binary tree with the structure of the BSP; item(index of a local solid) returns a leaf's part.
template <class Item>
int join_like(const BspTree& tree, Bvh8::Builder& builder, Item item) {
    std::vector<int> part(tree.nodes.size(), Bvh8::Builder::nothing);
    const auto list = [&](auto&& self, std::uint32_t first, std::uint32_t last) -> int {
        if (first == last) return Bvh8::Builder::nothing;
        if (last - first == 1) return item(first);
        const std::uint32_t middle = first + (last - first) / 2;
        const int a = self(self, first, middle), b = self(self, middle, last);
        return builder.join(a, b);
    };
    for (std::size_t i = tree.nodes.size(); i-- > 0;) {
        const BspNode& n = tree.nodes[i];
        if (n.axis == 3) {
            const BspCell& c = tree.cells[n.child];
            part[i] = list(list, c.first, c.first + c.count);
        } else {
            part[i] = builder.join(part[n.child], part[std::size_t(n.child) + 1]);
        }
    }
    return part[0];
}

// A BSP whose solids keep their numbers.
std::vector<NamedBsp> alone(BspTree&& tree) {
    std::vector<NamedBsp> all(1);
    for (std::size_t i = 0; i < tree.boxes.size(); ++i) all[0].solids.push_back(int(i));
    all[0].tree = std::move(tree);
    return all;
}

// Moves a BSP's local solids to `surfaces`, and appends the box of each cell primitive to `boxes`.
void add_primitives(NamedBsp& bsp, Surfaces& surfaces, std::vector<Box>& boxes) {
    const auto name = [&](const LocalSolid& local) { return bsp.solids[local.solid()]; };
    for (LocalSolid& plane : bsp.tree.planes) {
        const int solid = name(plane);
        surfaces.infinite_planes.add(std::move(plane), Box::everything(), solid);
    }
    const std::vector<Box> cells = cells_of_locals(bsp.tree);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        LocalSolid& local = bsp.tree.locals[i];
        const Box around = intersection(cells[i], bsp.tree.boxes[local.solid()]);
        const int solid = name(local);
        surfaces.cell_primitives.add(std::move(local), around, solid);
        boxes.push_back(surfaces.cell_primitives.surface_box(boxes.size(), bsp.tree.tolerances.margin()));
    }
}

}  // namespace

SurfaceTracer::SurfaceTracer(BspTree&& tree, Criterion criterion, Accel accel)
    : SurfaceTracer(alone(std::move(tree)), {}, criterion, accel) {}

SurfaceTracer::SurfaceTracer(std::vector<NamedBsp> bsps, std::span<const Box> instance_boxes, Criterion criterion,
                             Accel accel) {
    Tolerances tolerances = bsps[0].tree.tolerances;
    double min_scale = infinity;  // of BSPs that hold anything
    for (const NamedBsp& bsp : bsps) {
        tolerances.scale = std::max(tolerances.scale, bsp.tree.tolerances.scale);
        if (!bsp.tree.locals.empty()) min_scale = std::min(min_scale, bsp.tree.tolerances.scale);
    }
    surfaces_.scale = tolerances.scale;
    surfaces_.cell_primitives = surfaces_.infinite_planes = CellPrimitives(tolerances, criterion);
    surfaces_.instance_boxes.reserve(instance_boxes.size());
    for (const Box& box : instance_boxes) surfaces_.instance_boxes.push_back(inflated(box, tolerances.margin()));
    std::vector<Box> boxes;  // of cell primitives
    for (NamedBsp& bsp : bsps) add_primitives(bsp, surfaces_, boxes);
    build_bvh(std::move(bsps), boxes, instance_boxes, accel);
    // A prototype of infinite planes only has no vicinity: there rays are as exact as they can be.
    if (!around_.empty() || !bounded_) vicinity_ = Vicinity(around_, tolerances.scale, min_scale);
}

// Builds the BVH over the primitives (with these boxes) and the instances, and keeps the part of the BSPs that is still
// needed.
void SurfaceTracer::build_bvh(std::vector<NamedBsp> bsps, const std::vector<Box>& boxes,
                              std::span<const Box> instance_boxes, Accel accel) {
    Box world;
    for (const Box& box : instance_boxes) world = hull(world, box);
    for (const Box& box : boxes)
        if (box.finite())
            world = hull(world, box);
        else
            bounded_ = false;
    Bvh8::Builder builder;
    std::vector<int> parts;
    std::vector<NumberedBox> items;
    const std::size_t all = boxes.size() + instance_boxes.size();
    builder.reserve(all);
    items.reserve(all);
    parts.reserve(bsps.size() + instance_boxes.size());
    std::uint32_t first = 0;
    for (NamedBsp& bsp : bsps) {
        parts.push_back(join_like(bsp.tree, builder, [&](std::uint32_t i) {
            const Box box = intersection(boxes[first + i], world);
            if (box.empty()) return Bvh8::Builder::nothing;
            items.push_back({first + i, box});
            return builder.item(first + i, box);
        }));
        first += std::uint32_t(bsp.tree.locals.size());
        keep(std::move(bsp.tree));
    }
    for (const Box& box : instance_boxes) {
        items.push_back({first, box});
        parts.push_back(builder.item(first++, box));
    }
    for (const NumberedBox& item : items) around_ = hull(around_, item.box);
    if (accel == Accel::embree && items.size() > few)
        embree_.emplace(items);
    else
        boxes_ = Bvh8(builder, builder.join_by_area(std::move(parts)));
}

// Keeps a tree without its local solids, and without its nodes unless rays traverse it outside of the BVH.
void SurfaceTracer::keep(BspTree&& tree) {
    tree.locals.clear();
    tree.planes.clear();
    const bool walked = trees_.empty() && !bounded_;
    if (!walked) tree.nodes = {};
    trees_.push_back(std::move(tree));
}

}  // namespace deburr
