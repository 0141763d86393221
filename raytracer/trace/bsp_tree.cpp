#include "raytracer/trace/bsp_tree.hpp"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>
#include <span>

#include "bounds/bounding_box.hpp"
#include "raytracer/simd/packet_kernels.hpp"

namespace deburr {
namespace {

// In units of one visit of an inner node, some 5 ns: a plane; a density, by its number of half-spaces,
// of which the first three are mostly a product and more a sum of some; each leaf that CSG has to
// combine. Chosen by the time that csg_examples, variable_rounding, staplers and hole_punch took, to be
// built and to be traced.
constexpr double cost_node = 1.0, cost_flat = 3.0, cost_soft = 5.0, cost_half_space = 0.5;
constexpr double cost_further_half_space = 10.0, cost_csg_leaf = 10.0;
constexpr int few_factors = 3;
// Cells with no more half-spaces than this are split by what would be left of the solids on either
// side; larger ones by the solids' boxes and by a few such looks.
constexpr int few_half_spaces = 48;
// Halves of a cell with fewer are not worth a task, nor are looks at fewer.
constexpr int half_spaces_of_a_task = 200;
// Where a cell of many half-spaces gains nothing by any split, as a box around many facets does, a few
// further splits are tried before it is taken as it is; anew whenever a part of them is gone.
constexpr int many_half_spaces = 128, patience = 3;
constexpr double part_gone = 0.7;

// A cell is split only if that spares, for each ray through the whole scene, this much or more: a split takes some
// 4,000 of the units above, and is worth that if ten million rays are traced. Chosen by a plate of 1,000 holes, of
// which ten times as many cells as now were five times as long in the making and no faster. A model's cell must spare
// ten times as much: cells that follow every edge of 500 to 1,000,000 triangles would take gigabytes.
// Of other fields nothing: what their evaluation costs is not known here.
constexpr double least_gain_of_densities = 4e-4, least_gain_of_model = 4e-3;

// One solid as far as it reaches into a cell.
struct Item {
    int solid = 0;
    std::shared_ptr<const SolidTree> tree;  // pruned to the cell or to one around it
    Box box;                                // of the solid
    LocalSolidSize size;                    // in the cell
};

double cost(const LocalSolidSize& size) {
    if (size.side != Side::straddling) return 0;
    if (size.half_spaces <= 1) return cost_flat;
    return cost_soft + cost_half_space * size.half_spaces +
           cost_further_half_space * std::max(0, size.half_spaces - few_factors) +
           (size.leaves > 1 ? cost_csg_leaf * size.leaves : 0);
}

struct Split {
    double cost = infinity, position = 0;
    int axis = -1;
};

// A part of the tree as it is built: both halves of it, or the cell's solids.
struct Branch {
    Split split;
    std::unique_ptr<Branch> child[2];
    std::vector<LocalSolid> locals;
    std::exception_ptr error;
};

// Splits without a gain that are left, and what must be left of the half-spaces for more.
struct Patience {
    int splits = patience;
    double half_spaces = infinity;
};

// With every filter that is too small to be sampled made sharp.
std::shared_ptr<const SolidTree> without_tiny_radii(std::shared_ptr<const SolidTree> tree, double least) {
    const auto tiny = [&](const HalfSpace& h) { return h.radius > 0 && h.radius < least; };
    const auto has_tiny = [&](const SolidLeaf& leaf) {
        return std::any_of(leaf.density.half_spaces.begin(), leaf.density.half_spaces.end(), tiny);
    };
    if (std::none_of(tree->leaves.begin(), tree->leaves.end(), has_tiny)) return tree;
    auto to = std::make_shared<SolidTree>(*tree);
    for (SolidLeaf& leaf : to->leaves)
        for (HalfSpace& h : leaf.density.half_spaces)
            if (tiny(h)) h.radius = 0;
    return to;
}

class Builder {
public:
    Builder(RootMethod root_method, double min_scale, ExpectedRays rays)
        : root_method_(root_method), min_scale_(min_scale), rays_(rays) {}

    BspTree run(const std::vector<Solid>& solids) {
        std::vector<Item> items;
        Box bounds;
        double coordinate_bound = 0;
        for (std::size_t i = 0; i < solids.size(); ++i) {
            auto tree = std::make_shared<const SolidTree>(flatten(solids[i]));
            for (const SolidLeaf& leaf : tree->leaves) {
                bsp_.half_spaces += leaf.density.half_spaces.size();
                for (const HalfSpace& h : leaf.density.half_spaces)
                    coordinate_bound = std::max(coordinate_bound, std::abs(h.offset));
                if (!leaf.field) continue;
                bsp_.half_spaces += std::size_t(leaf.field->size());
                const Box extent = leaf.field->extent();
                if (extent.finite() && !extent.empty()) bounds = hull(bounds, extent);
            }
            const Box box = bounding_box(*tree);
            if (box.empty()) continue;
            if (box.finite()) bounds = hull(bounds, box);
            items.push_back({int(i), tree, box, {}});
        }
        if (bounds.empty()) bounds = {Vec3(-coordinate_bound - 1), Vec3(coordinate_bound + 1)};
        const double scale = std::max({min_scale_, largest(bounds.lo), largest(bounds.hi)});
        bsp_.tolerances.scale = scale > 0 ? scale : 1;
        margin_ = bsp_.tolerances.margin();
        const Vec3 sides = bounds.hi - bounds.lo;
        const double size = std::max({sides.x, sides.y, sides.z});
        world_ = inflated(bounds, 0.05 * size + margin_);
        smallest_ = 1e-5 * size;
        max_depth_ = 16 + int(2.5 * std::log2(1.0 + double(bsp_.half_spaces)));
        for (Item& item : items) {
            item.tree = without_tiny_radii(std::move(item.tree), bsp_.tolerances.min_radius());
            item.size = local_size(*item.tree, Box::everything());
        }
        bsp_.boxes.assign(solids.size(), Box::everything());
        for (const Item& item : items) bsp_.boxes[item.solid] = inflated(item.box, margin_);
        // A floor in every cell would leave none of them empty.
        std::erase_if(items, [&](const Item& item) {
            if (item.size.half_spaces != 1) return false;
            LocalSolid plane(item.solid, *item.tree, Box::everything(), bsp_.tolerances);
            if (plane.has_surface()) bsp_.planes.push_back(std::move(plane));
            return true;
        });
        if (rays_ == ExpectedRays::few && is_one_product(items)) max_depth_ = 0;
        Branch root;
        split(root, Box::everything(), std::move(items), 0, {});
        bsp_.nodes.emplace_back();
        lay_out(root, 0, 0);
        return std::move(bsp_);
    }

private:
    bool is_one_product(const std::vector<Item>& items) const {
        if (items.size() != 1 || items[0].size.half_spaces > max_packet_factors || items[0].tree->leaves.size() != 1)
            return false;
        const LocalSolid whole(0, *items[0].tree, Box::everything(), bsp_.tolerances, root_method_);
        return whole.convex().has_value();
    }

    // Area of the part of a cell that the scene can be seen through.
    double area(const Box& cell) const { return half_area(intersection(cell, world_)); }

    Box side(const Box& cell, int axis, double position, bool upper) const {
        Box b = cell;
        (upper ? b.lo : b.hi)[axis] = position;
        return b;
    }

    static bool is_model(const std::vector<Item>& items) {
        return items.size() == 1 && items[0].tree->leaves.size() == 1 && items[0].tree->leaves[0].field &&
               items[0].tree->leaves[0].field->is_density();
    }

    static double least_gain(const std::vector<Item>& items) {
        if (is_model(items)) return least_gain_of_model;
        for (const Item& item : items)
            for (const SolidLeaf& leaf : item.tree->leaves)
                if (leaf.field && !leaf.field->is_density()) return 0;
        return least_gain_of_densities;
    }

    bool misses(const Item& item, const Box& cell) const {
        return intersection(item.box, inflated(cell, margin_)).empty();
    }

    // Both halves at once where that pays; what is built is the same.
    void split(Branch& to, const Box& cell, std::vector<Item> items, int depth, Patience patient) const {
        double here = 0;
        int half_spaces = 0;
        for (const Item& item : items) {
            here += cost(item.size);
            half_spaces += item.size.half_spaces;
        }
        if (half_spaces <= part_gone * patient.half_spaces) patient = {patience, double(half_spaces)};
        Split best;
        const bool of_model = is_model(items);
        // What a split must spare of the cost here.
        const double least = least_gain(items) * area(world_) / area(cell);
        if (depth < max_depth_ && here > std::max(cost_node + cost_flat, least)) {
            if (of_model && half_spaces > few_half_spaces) best = middle(cell, items[0]);
            if (best.axis < 0)
                best = half_spaces <= few_half_spaces || items.size() == 1 ? best_local(cell, items)
                                                                           : best_of_boxes(cell, items);
        }
        if (best.cost >= here && (half_spaces <= many_half_spaces || patient.splits-- == 0)) best.axis = -1;
        if (best.cost < here && here - best.cost < least) best.axis = -1;
        if (best.axis < 0) {
            make_cell(to, cell, items);
            return;
        }
        to.split = best;
        std::vector<Item> inside[2];
        const auto half = [&](int upper) {
            const Box part = side(cell, best.axis, best.position, upper);
            for (const Item& item : items) {
                if (misses(item, part)) continue;
                Item in = item;
                // A solid that the part holds whole looks the same in it.
                const bool whole = part.contains(item.box.lo) && part.contains(item.box.hi);
                if (!whole || item.size.half_spaces > few_half_spaces) {
                    const Box known = inflated(part, margin_);
                    in.size = local_size(*item.tree, known);
                    if (in.size.side != Side::straddling) continue;
                    if (in.size.half_spaces < item.size.half_spaces)
                        in.tree = std::make_shared<const SolidTree>(prune(*item.tree, known));
                }
                inside[upper].push_back(std::move(in));
            }
        };
        const auto descend = [&](int upper) {
            to.child[upper] = std::make_unique<Branch>();
            split(*to.child[upper], side(cell, best.axis, best.position, upper), std::move(inside[upper]), depth + 1,
                  patient);
        };
        if (half_spaces < half_spaces_of_a_task) {
            half(0);
            half(1);
            items.clear();
            descend(0);
            descend(1);
        } else {
            tbb::parallel_invoke([&] { half(0); }, [&] { half(1); });
            items.clear();
            tbb::parallel_invoke([&] { descend(0); }, [&] { descend(1); });
        }
    }

    void lay_out(Branch& from, std::size_t node, int depth) {
        if (from.error) std::rethrow_exception(from.error);
        bsp_.depth = std::max(bsp_.depth, depth);
        if (!from.child[0]) {
            bsp_.nodes[node] = {0, 3, int(bsp_.cells.size())};
            bsp_.cells.push_back({std::uint32_t(bsp_.locals.size()), std::uint32_t(from.locals.size())});
            for (LocalSolid& local : from.locals) bsp_.locals.push_back(std::move(local));
            return;
        }
        const std::size_t child = bsp_.nodes.size();
        bsp_.nodes[node] = {from.split.position, from.split.axis, int(child)};
        bsp_.nodes.resize(child + 2);
        for (const bool upper : {false, true}) {
            lay_out(*from.child[upper], child + upper, depth + 1);
            from.child[upper].reset();
        }
    }

    void consider(Split& best, const Box& cell, int axis, double position, double low, double high) const {
        const double whole = area(cell);
        if (!(whole > 0)) return;
        const double pl = area(side(cell, axis, position, false)) / whole;
        const double pu = area(side(cell, axis, position, true)) / whole;
        const double total = cost_node + pl * low + pu * high;
        if (total < best.cost) best = {total, position, axis};
    }

    // Candidates on one axis: where boxes end, where half-spaces begin and cease to vary, and even
    // steps between.
    std::vector<double> candidates(const Box& cell, const std::vector<Item>& items, int axis) const {
        std::vector<double> at;
        Box part;
        for (const Item& item : items) {
            part = hull(part, intersection(item.box, cell));
            at.push_back(item.box.lo[axis] - 2 * margin_);
            at.push_back(item.box.hi[axis] + 2 * margin_);
            if (item.size.half_spaces > few_half_spaces) continue;
            const auto add = [&](const std::vector<HalfSpace>& planes) {
                for (const HalfSpace& h : planes) {
                    if (std::abs(h.normal[axis]) < 1 - 1e-9) continue;
                    const double position = h.offset / h.normal[axis];
                    at.push_back(position - h.radius - 2 * margin_);
                    at.push_back(position + h.radius + 2 * margin_);
                }
            };
            for (const SolidLeaf& leaf : item.tree->leaves) {
                add(leaf.density.half_spaces);
                if (leaf.field) add(leaf.field->planes());
            }
        }
        part = intersection(part, world_);
        for (int k = 1; k <= 3; ++k) at.push_back(part.lo[axis] + (part.hi[axis] - part.lo[axis]) * k / 4);
        const double lo = std::max(cell.lo[axis], world_.lo[axis]) + smallest_;
        const double hi = std::min(cell.hi[axis], world_.hi[axis]) - smallest_;
        std::erase_if(at, [&](double x) { return !(x > lo && x < hi); });
        std::sort(at.begin(), at.end());
        at.erase(std::unique(at.begin(), at.end(), [&](double a, double b) { return b - a < smallest_; }), at.end());
        return at;
    }

    Split best_local(const Box& cell, const std::vector<Item>& items) const {
        struct Trial {
            int axis;
            double position, sum[2];
        };
        std::vector<Trial> trials;
        for (int axis = 0; axis < 3; ++axis)
            for (const double position : candidates(cell, items, axis)) trials.push_back({axis, position, {0, 0}});
        // A few trials are looked at together.
        constexpr std::size_t together = 8;
        const std::size_t blocks = (trials.size() + together - 1) / together;
        const auto evaluate = [&](std::size_t block) {
            const std::span<Trial> some =
                std::span(trials).subspan(block * together, std::min(together, trials.size() - block * together));
            Box parts[2 * together];
            double* sums[2 * together];
            LocalSolidSize sizes[2 * together];
            for (const Item& item : items) {
                std::size_t count = 0;
                for (Trial& trial : some)
                    for (const bool upper : {false, true}) {
                        const Box part = side(cell, trial.axis, trial.position, upper);
                        if (misses(item, part)) continue;  // costs nothing
                        parts[count] = inflated(part, margin_);
                        sums[count++] = &trial.sum[upper];
                    }
                local_sizes(*item.tree, {parts, count}, sizes);
                for (std::size_t k = 0; k < count; ++k) *sums[k] += cost(sizes[k]);
            }
        };
        int half_spaces = 0;
        for (const Item& item : items) half_spaces += item.size.half_spaces;
        if (half_spaces < half_spaces_of_a_task)
            for (std::size_t i = 0; i < blocks; ++i) evaluate(i);
        else
            tbb::parallel_for(std::size_t(0), blocks, evaluate);
        Split best;
        for (const Trial& l : trials) consider(best, cell, l.axis, l.position, l.sum[0], l.sum[1]);
        return best;
    }

    // Across the longest side of what the cell holds of a model, if that is long for the model's filter: then it spares
    // something, and it is not asked how much.
    Split middle(const Box& cell, const Item& item) const {
        const Box part = intersection(intersection(item.box, cell), world_);
        if (part.empty()) return {};
        const Vec3 size = part.hi - part.lo;
        const int axis = greatest_axis(size);
        constexpr double long_side = 8;  // in radii
        if (size[axis] < std::max(2 * smallest_, long_side * item.tree->leaves[0].field->filter_radius())) return {};
        return {0, 0.5 * (part.lo[axis] + part.hi[axis]), axis};
    }

    // By the ends of the solids' boxes alone: one sweep an axis.
    Split best_of_boxes(const Box& cell, const std::vector<Item>& items) const {
        Split best;
        for (int axis = 0; axis < 3; ++axis) {
            std::vector<std::pair<double, double>> begin, end;  // position, cost
            double above = 0;
            for (const Item& item : items) {
                const double c = cost(item.size);
                begin.push_back({item.box.lo[axis] - 2 * margin_, c});
                end.push_back({item.box.hi[axis] + 2 * margin_, c});
                above += c;
            }
            std::sort(begin.begin(), begin.end());
            std::sort(end.begin(), end.end());
            const double lo = std::max(cell.lo[axis], world_.lo[axis]) + smallest_;
            const double hi = std::min(cell.hi[axis], world_.hi[axis]) - smallest_;
            double below = 0;
            std::size_t b = 0, e = 0;
            while (b < begin.size() || e < end.size()) {
                const bool ends = e < end.size() && (b >= begin.size() || end[e].first <= begin[b].first);
                const double position = ends ? end[e].first : begin[b].first;
                // What ends here is no longer above; what begins here is not yet below.
                while (e < end.size() && end[e].first <= position) above -= end[e++].second;
                if (position > lo && position < hi) consider(best, cell, axis, position, below, above);
                while (b < begin.size() && begin[b].first <= position) below += begin[b++].second;
            }
        }
        return best;
    }

    void make_cell(Branch& to, const Box& cell, const std::vector<Item>& items) const try {
        const Box known = inflated(cell, margin_);
        for (const Item& item : items) {
            const SolidTree local = prune(*item.tree, known);
            LocalSolid solid(item.solid, local, known, bsp_.tolerances, root_method_);
            if (solid.has_surface()) to.locals.push_back(std::move(solid));
        }
    } catch (const std::bad_alloc&) {
        throw;  // at once: others will not find memory either
    } catch (...) {
        to.error = std::current_exception();  // the first one in the tree's order is thrown
    }

    RootMethod root_method_;
    double min_scale_;
    ExpectedRays rays_;
    BspTree bsp_;
    Box world_;
    double margin_ = 0, smallest_ = 0;
    int max_depth_ = 0;
};

}  // namespace

BspTree build_bsp(const std::vector<Solid>& solids, RootMethod root_method, double min_scale, ExpectedRays rays) {
    return Builder(root_method, min_scale, rays).run(solids);
}

}  // namespace deburr
