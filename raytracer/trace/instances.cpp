#include "raytracer/trace/instances.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <span>
#include <unordered_map>

#include "bounds/bounding_box.hpp"
#include "bounds/canonical_solids.hpp"
#include "bounds/in_parallel.hpp"
#include "bounds/union_find.hpp"

namespace deburr {
namespace {

// Depth of prototypes within prototypes, beyond which solids are not shared.
constexpr int max_nesting = 8;
// Condition number of an instance's map up to which it is used: a larger one would magnify rounding errors too much.
constexpr double largest_condition = 64;
// A shape farther from its origin than this many of its sizes is moved there.
constexpr double farthest = 16;
// A solid smaller than this fraction of the prototype that it is in becomes an instance, with a BVH of its own, whose
// single precision is finer.
constexpr double min_size = 0x1p-10;
// The scale of tolerances of a small solid's BSP is at least this fraction of the largest one in its prototype: cells
// must know their solids farther beyond their walls (2⁻³⁸ of their scale) than a ray's position is off (a few times
// 2⁻⁵⁰ of the larger scale).
constexpr double min_share_of_scale = 0x1p-8;

// The box of a union with more half-spaces than this is the hull of its operands' boxes. Smaller ones are flattened
// first, since rotated operands may then have a smaller box.
constexpr double max_flattened = 4096;
// This many prototypes are built in advance, with their statistics. Further ones that are a single rounded density with
// few half-spaces, whose construction cannot fail (their diagram is never too large), are built on demand.
constexpr std::size_t max_built_beforehand = 1000;
constexpr double few_half_spaces = 12;

bool is_quick_to_build(const Solid& solid) {
    const SolidNode* node = &solid.node();
    while (node->kind == SolidNode::Kind::transform || node->kind == SolidNode::Kind::material)
        node = &node->children()[0].node();
    return node->kind == SolidNode::Kind::rounded && !node->convolved() && node->leaves <= few_half_spaces;
}

// Frobenius norm.
double norm(const Mat3& m) { return std::sqrt(glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2])); }

// A solid, or an operand of a union, to be placed in a prototype.
struct Part {
    CanonicalPlacement placed;
    int solid;
    Box box;
};

bool is_turned(const Mat3& m) {
    return m[0][1] != 0 || m[0][2] != 0 || m[1][0] != 0 || m[1][2] != 0 || m[2][0] != 0 || m[2][1] != 0;
}

using Placements = LargeVector<CanonicalPlacement>;

// The content of one BSP.
struct Group {
    std::vector<Solid> solids;
    std::vector<int> numbers;  // indices of the solids in the prototype
};

// A prototype before it is built.
struct PlannedPrototype {
    std::vector<Group> groups{1};  // first: the unbounded and badly conditioned solids, or all
    double coordinate_bound = 0;   // of the other groups
    Instances instances;
    LargeVector<Box> boxes;  // of the instances, in the prototype's coordinates
};

// Decides what becomes a prototype, what an instance, and what is stored with its surroundings.
class Plan {
public:
    explicit Plan(const std::vector<Solid>& solids) {
        prototypes.emplace_back();
        fill(0, solids, 0);
    }

    std::vector<PlannedPrototype> prototypes;
    std::vector<Solid> later;  // alone in their prototypes, which are numbered after all others

    /// The final number of a prototype. While planning, those in `later` are ~index, because the number of `prototypes`
    /// is not known yet.
    int number_of(int prototype) const { return prototype < 0 ? int(prototypes.size()) + ~prototype : prototype; }

private:
    bool is_union(int canonical) const { return canonical_.solid(canonical).node().kind == SolidNode::Kind::unite; }

    // The placement of a child of a placed union.
    CanonicalPlacement within(const CanonicalPlacement& outer, const Solid& child) {
        CanonicalPlacement to = canonical_.of(child);
        to.map = compose(outer.map, to.map);
        if (to.material < 0) to.material = outer.material;
        return to;
    }

    using Counts = std::unordered_map<int, double>;

    /// How often each canonical shape occurs, counted through unions.
    Counts occurrences(const Placements& roots) {
        Counts count;
        std::map<int, double, std::greater<int>> open;  // parts have lower numbers than their unions
        for (const CanonicalPlacement& root : roots) open[root.canonical] += 1;
        while (!open.empty()) {
            const auto [canonical, times] = *open.begin();
            open.erase(open.begin());
            count[canonical] = times;
            if (!is_union(canonical)) continue;
            const Solid solid = canonical_.solid(canonical);
            for (const Solid& child : solid.node().children()) open[canonical_.of(child).canonical] += times;
        }
        return count;
    }

    bool is_large_union(int canonical) const {
        return is_union(canonical) && canonical_.solid(canonical).node().leaves > max_flattened;
    }

    /// The box of a canonical shape in its own coordinates. Iterative, since unions may be long chains.
    const Box& box(int root) {
        std::vector<int> open{root};
        while (!open.empty()) {
            const int canonical = open.back();
            if (boxes_.count(canonical)) {
                open.pop_back();
                continue;
            }
            if (!is_large_union(canonical)) {
                boxes_[canonical] = bounding_box(flatten(canonical_.solid(canonical)));
                continue;
            }
            Box around;
            bool known = true;
            const Solid solid = canonical_.solid(canonical);
            for (const Solid& child : solid.node().children()) {
                const CanonicalPlacement part = canonical_.of(child);
                const auto at = boxes_.find(part.canonical);
                if (at == boxes_.end()) {
                    open.push_back(part.canonical);
                    known = false;
                } else if (!at->second.empty()) {
                    around = hull(around, placed_box(part.map, at->second));
                }
            }
            if (known) boxes_[canonical] = around;
        }
        return boxes_.at(root);
    }

    static Box placed_box(const Affine& map, const Box& box) {
        return box.finite() ? image(map, box) : Box::everything();
    }

    /// Computes the boxes of the shapes that are no unions, in parallel.
    void find_boxes(const Placements& all) {
        std::vector<std::pair<const int, Box>*> open;
        for (const CanonicalPlacement& p : all)
            if (!is_union(p.canonical))
                if (const auto [at, is_new] = boxes_.try_emplace(p.canonical); is_new) open.push_back(&*at);
        in_parallel(open.size(),
                    [&](std::size_t i) { open[i]->second = bounding_box(flatten(canonical_.solid(open[i]->first))); });
    }

    /// The operands of a union, expanded down to unions that occur more than once.
    Placements operands(const CanonicalPlacement& root, const Counts& count) {
        Placements open{root}, all;
        while (!open.empty()) {
            const CanonicalPlacement now = open.back();
            open.pop_back();
            if (!is_union(now.canonical) || (now.canonical != root.canonical && count.at(now.canonical) > 1)) {
                all.push_back(now);
                continue;
            }
            const Solid solid = canonical_.solid(now.canonical);
            const auto children = solid.node().children();
            for (auto child = children.rbegin(); child != children.rend(); ++child) open.push_back(within(now, *child));
        }
        return all;
    }

    Solid solid_of(const CanonicalPlacement& placed) const {
        const Solid solid = canonical_.solid(placed.canonical).transformed(placed.map);
        return placed.material < 0 ? solid : solid.material(placed.material);
    }

    /// Clusters of boxes that nearly meet, directly or through others: sorted indices, ordered by their least index.
    static std::vector<std::vector<int>> clusters(std::span<const Box> boxes, double clearance) {
        Bvh8::Builder builder;
        std::vector<int> items;
        for (std::size_t i = 0; i < boxes.size(); ++i) items.push_back(builder.item(std::uint32_t(i), boxes[i]));
        const Bvh8 tree(builder, builder.join_by_area(std::move(items)));
        UnionFind together(boxes.size());
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            const Box near = inflated(boxes[i], clearance);
            tree.meeting(near, [&](std::uint32_t j) {
                if (j < i || intersection(near, boxes[j]).empty()) return;
                const int a = together.find(int(i)), b = together.find(int(j));
                together.join(std::min(a, b), std::max(a, b));
            });
        }
        std::vector<std::vector<int>> all;
        std::vector<int> cluster_of(boxes.size(), -1);
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            int& cluster = cluster_of[together.find(int(i))];
            if (cluster < 0) {
                cluster = int(all.size());
                all.emplace_back();
            }
            all[cluster].push_back(int(i));
        }
        return all;
    }

    /// Splits a union that occurs once into parts; operands that meet stay together.
    void take_apart(const CanonicalPlacement& root, int solid, const Counts& count, LargeVector<Part>& parts) {
        if (!is_union(root.canonical) || count.at(root.canonical) > 1) {
            const Box own = box(root.canonical);
            if (!own.empty()) parts.push_back({root, solid, placed_box(root.map, own)});
            return;
        }
        Placements all = operands(root, count);
        find_boxes(all);
        std::erase_if(all, [&](const CanonicalPlacement& p) { return box(p.canonical).empty(); });
        if (all.empty()) return;
        LargeVector<Box> boxes;
        Box around;
        for (const CanonicalPlacement& p : all) {
            boxes.push_back(placed_box(p.map, box(p.canonical)));
            around = hull(around, boxes.back());
        }
        const bool bounded = std::all_of(boxes.begin(), boxes.end(), [](const Box& b) { return b.finite(); });
        if (all.size() == 1 || !bounded) {
            parts.push_back({root, solid, bounded ? boxes[0] : Box::everything()});
            return;
        }
        const double clearance =
            std::max(largest(around.lo), largest(around.hi)) * 0x1p-30;  // more than any cell's margin
        for (const std::vector<int>& members : clusters(boxes, clearance)) {
            Part part{all[members[0]], solid, {}};
            for (const int i : members) part.box = hull(part.box, boxes[i]);
            if (members.size() == all.size())
                part.placed = root;
            else if (members.size() > 1)
                part.placed = canonical_.of(sum(all, members));
            parts.push_back(part);
        }
    }

    // The union of these operands. It is kept in sums_, since canonical_ refers to it.
    Solid sum(const Placements& all, const std::vector<int>& members) {
        Solid to = solid_of(all[members[0]]);
        for (std::size_t k = 1; k < members.size(); ++k) to = to | solid_of(all[members[k]]);
        sums_.push_back(to);
        return to;
    }

    void put(int prototype, Group& group, const Solid& solid, int number) {
        // Below the world, materials that are not set stay so, to be set by the instance.
        group.solids.push_back(prototype == 0 ? solid : solid.material(-1));
        group.numbers.push_back(number);
    }

    // Distributes the solids of a prototype to its groups and instances.
    void fill(int prototype, const std::vector<Solid>& solids, int depth) {
        if (depth == max_nesting) {
            for (std::size_t i = 0; i < solids.size(); ++i)
                put(prototype, prototypes[prototype].groups[0], solids[i], int(i));
            return;
        }
        Placements roots;
        roots.reserve(solids.size());
        for (const Solid& s : solids) roots.push_back(canonical_.of(s));
        const Counts count = occurrences(roots);
        find_boxes(roots);
        LargeVector<Part> parts;
        parts.reserve(roots.size());
        for (std::size_t i = 0; i < roots.size(); ++i) take_apart(roots[i], int(i), count, parts);
        std::unordered_map<int, int> uses;
        Box around;
        for (const Part& part : parts) {
            ++uses[part.placed.canonical];
            if (part.box.finite()) around = hull(around, part.box);
        }
        const double whole = largest(around.hi - around.lo);
        prototypes[prototype].instances.reserve(parts.size() - uses.size());  // at least
        prototypes[prototype].boxes.reserve(parts.size() - uses.size());
        for (const Part& part : parts) {
            const Mat3& linear = part.placed.map.linear;
            PlannedPrototype& here = prototypes[prototype];
            if (parts.size() == 1 || !part.box.finite() ||
                !(norm(linear) * norm(glm::inverse(linear)) < largest_condition)) {
                put(prototype, here.groups[0], solid_of(part.placed), part.solid);
                continue;
            }
            const double size = largest(part.box.hi - part.box.lo),
                         coordinate_bound = std::max(largest(part.box.lo), largest(part.box.hi));
            const bool fits = coordinate_bound <= farthest * size && size >= min_size * whole;
            if (fits && uses.at(part.placed.canonical) == 1 && !is_turned(linear) &&
                !prototype_of_.count(part.placed.canonical)) {
                put(prototype, here.groups.emplace_back(), solid_of(part.placed), part.solid);
                here.coordinate_bound = std::max(here.coordinate_bound, coordinate_bound);
                continue;
            }
            place(prototype, part, depth);
            prototypes[prototype].boxes.push_back(part.box);
        }
    }

    // Adds an instance of the part, and its prototype if it is new.
    void place(int prototype, const Part& part, int depth) {
        const int canonical = part.placed.canonical;
        const Box own = box(canonical);
        const Vec3 sides = own.hi - own.lo;
        Affine centered;  // of the prototype in the shape's coordinates
        if (std::max(largest(own.lo), largest(own.hi)) > farthest * largest(sides))
            centered.shift = 0.5 * (own.lo + own.hi);
        const auto [at, is_new] = prototype_of_.try_emplace(canonical, int(prototypes.size()));
        if (is_new) {
            const Affine to_middle{Mat3(1.0), -centered.shift};
            const Solid solid = canonical_.solid(canonical);
            if (prototypes.size() >= max_built_beforehand && is_quick_to_build(solid)) {
                at->second = ~int(later.size());
                later.push_back(solid.transformed(to_middle).material(-1));
            } else {
                prototypes.emplace_back();
                fill(at->second, {centered.shift == Vec3(0.0) ? solid : solid.transformed(to_middle)}, depth + 1);
            }
        }
        const int number = prototype_of_.at(canonical);
        const Affine map = compose(part.placed.map, centered);
        const Affine into = inverse(map);
        prototypes[prototype].instances.push_back(
            {into, norm(map.linear), number, part.solid, part.placed.material, into.linear == Mat3(1.0)});
    }

    CanonicalSolids canonical_;
    std::vector<Solid> sums_;
    std::unordered_map<int, Box> boxes_;
    std::unordered_map<int, int> prototype_of_;
};

}  // namespace

Prototypes::Prototypes(const std::vector<Solid>& solids, Criterion criterion, RootMethod root_method, Accel accel,
                       BspStore* store)
    : criterion_(criterion), root_method_(root_method), accel_(accel) {
    Plan plan(solids);
    if (store) store->begin_scene();
    later_ = std::move(plan.later);
    prototypes_ = std::vector<std::atomic<const Prototype*>>(plan.prototypes.size() + later_.size());
    std::vector<std::unique_ptr<const Prototype>> all(plan.prototypes.size());
    in_parallel(all.size(), [&](std::size_t i) {
        PlannedPrototype& planned = plan.prototypes[i];
        for (Instance& p : planned.instances) p.prototype = plan.number_of(p.prototype);
        std::vector<NamedBsp> bsps(planned.groups.size());
        const auto build = [&](std::size_t k, double min_scale) {
            const std::vector<Solid>& of = planned.groups[k].solids;
            bsps[k] = {store ? store->bsp(of, root_method, min_scale) : build_bsp(of, root_method, min_scale),
                       std::move(planned.groups[k].numbers)};
        };
        build(0, 0);
        const double scale = std::max(bsps[0].tree.tolerances.scale, planned.coordinate_bound);
        in_parallel(bsps.size() - 1, [&](std::size_t k) { build(k + 1, min_share_of_scale * scale); });
        auto prototype = std::make_unique<Prototype>(
            Prototype{SurfaceTracer(std::move(bsps), planned.boxes, criterion, accel), std::move(planned.instances)});
        prototype->tracer.instances_lie_at(prototype->instances.data(), sizeof(Instance));
        all[i] = std::move(prototype);
    });
    for (std::size_t i = 0; i < all.size(); ++i) prototypes_[i] = all[i].release();
}

Prototypes::~Prototypes() {
    for (const auto& prototype : prototypes_) delete prototype.load();
}

// No lock is used: a thread that waits for one could have been given work that needs it. If several threads build a
// prototype at the same time, the first result is kept; all are the same.
const Prototype& Prototypes::build(std::size_t i) const {
    const std::size_t beforehand = prototypes_.size() - later_.size();
    std::vector<NamedBsp> alone(1);
    alone[0] = {build_bsp({later_[i - beforehand]}, root_method_, 0, ExpectedRays::few), {0}};
    auto prototype =
        std::make_unique<const Prototype>(Prototype{SurfaceTracer(std::move(alone), {}, criterion_, accel_), {}});
    const Prototype* there = nullptr;
    if (prototypes_[i].compare_exchange_strong(there, prototype.get())) there = prototype.release();
    return *there;
}

}  // namespace deburr
