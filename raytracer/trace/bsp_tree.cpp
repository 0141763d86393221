#include "raytracer/trace/bsp_tree.hpp"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>

#include "bounds/bounding_box.hpp"
#include "raytracer/simd/packet_kernels.hpp"
#include "raytracer/trace/bsp_split.hpp"

namespace deburr {
namespace {

// Where no split reduces the cost of a cell with many half-spaces, as for a box around many facets, a few more splits
// are tried before it stays whole; the count starts again whenever this fraction of them is left.
constexpr int many_half_spaces = 128, patience = 3;
constexpr double part_gone = 0.7;

// A subtree while it is built: two halves, or the local solids of a cell.
struct Branch {
    BspSplit split;
    std::unique_ptr<Branch> child[2];
    std::vector<LocalSolid> locals;
    std::exception_ptr error;  // thrown while making the cell
};

// How many splits without a gain may follow, and the number of half-spaces when that count was last reset.
struct Patience {
    int splits = patience;
    double half_spaces = infinity;
};

// The tree with filters smaller than `least` replaced by sharp half-spaces.
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
        std::vector<BspItem> items = items_of(solids);
        set_scale();
        for (BspItem& item : items) {
            item.tree = without_tiny_radii(std::move(item.tree), bsp_.tolerances.min_radius());
            item.size = local_size(*item.tree, Box::everything());
        }
        bsp_.boxes.assign(solids.size(), Box::everything());
        for (const BspItem& item : items) bsp_.boxes[item.solid] = inflated(item.box, margin_);
        take_planes(items);
        if (rays_ == ExpectedRays::few && is_one_product(items)) max_depth_ = 0;
        Branch root;
        split(root, Box::everything(), std::move(items), 0, {});
        bsp_.nodes.emplace_back();
        lay_out(root, 0, 0);
        return std::move(bsp_);
    }

private:
    // The solids that have a surface. Extends bounds_ by the bounded ones.
    std::vector<BspItem> items_of(const std::vector<Solid>& solids) {
        std::vector<BspItem> items;
        for (std::size_t i = 0; i < solids.size(); ++i) {
            auto tree = std::make_shared<const SolidTree>(flatten(solids[i]));
            for (const SolidLeaf& leaf : tree->leaves) count(leaf);
            const Box box = bounding_box(*tree);
            if (box.empty()) continue;
            if (box.finite()) bounds_ = hull(bounds_, box);
            items.push_back({int(i), tree, box, {}});
        }
        if (bounds_.empty()) bounds_ = {Vec3(-coordinate_bound_ - 1), Vec3(coordinate_bound_ + 1)};
        return items;
    }

    void count(const SolidLeaf& leaf) {
        bsp_.half_spaces += leaf.density.half_spaces.size();
        for (const HalfSpace& h : leaf.density.half_spaces)
            coordinate_bound_ = std::max(coordinate_bound_, std::abs(h.offset));
        if (!leaf.field) return;
        bsp_.half_spaces += std::size_t(leaf.field->size());
        const Box extent = leaf.field->extent();
        if (extent.finite() && !extent.empty()) bounds_ = hull(bounds_, extent);
    }

    void set_scale() {
        const double scale = std::max({min_scale_, largest(bounds_.lo), largest(bounds_.hi)});
        bsp_.tolerances.scale = scale > 0 ? scale : 1;
        margin_ = bsp_.tolerances.margin();
        const Vec3 sides = bounds_.hi - bounds_.lo;
        const double size = max_component(sides);
        splitter_ = BspSplitter(inflated(bounds_, 0.05 * size + margin_), margin_, 1e-5 * size);
        max_depth_ = 16 + int(2.5 * std::log2(1.0 + double(bsp_.half_spaces)));
    }

    // Moves the items that are a single half-space from the cells to bsp_.planes: a floor in every cell would leave
    // none empty.
    void take_planes(std::vector<BspItem>& items) {
        std::erase_if(items, [&](const BspItem& item) {
            if (item.size.half_spaces != 1) return false;
            LocalSolid plane(item.solid, *item.tree, Box::everything(), bsp_.tolerances);
            if (plane.has_surface()) bsp_.planes.push_back(std::move(plane));
            return true;
        });
    }

    bool is_one_product(const std::vector<BspItem>& items) const {
        if (items.size() != 1 || items[0].size.half_spaces > max_packet_factors || items[0].tree->leaves.size() != 1)
            return false;
        const LocalSolid whole(0, *items[0].tree, Box::everything(), bsp_.tolerances, root_method_);
        return whole.convex().has_value();
    }

    // The split of a cell; axis −1 if it stays whole.
    BspSplit split_of(const Box& cell, const std::vector<BspItem>& items, BspCost here, int depth,
                      Patience& patient) const {
        if (here.half_spaces <= part_gone * patient.half_spaces) patient = {patience, double(here.half_spaces)};
        const double least = splitter_.least_gain(cell, items);
        BspSplit best;
        if (depth < max_depth_ && here.cost > std::max(cost_node + cost_flat, least))
            best = splitter_.best(cell, items, here.half_spaces);
        if (best.cost >= here.cost && (here.half_spaces <= many_half_spaces || patient.splits-- == 0)) best.axis = -1;
        if (best.cost < here.cost && here.cost - best.cost < least) best.axis = -1;
        return best;
    }

    // The items, pruned to a part of their cell; those without a surface there are dropped.
    std::vector<BspItem> items_in(const Box& part, const std::vector<BspItem>& items) const {
        std::vector<BspItem> inside;
        for (const BspItem& item : items) {
            if (splitter_.misses(item, part)) continue;
            BspItem in = item;
            // Pruning a small solid that is wholly inside the part changes nothing.
            const bool whole = part.contains(item.box.lo) && part.contains(item.box.hi);
            if (!whole || item.size.half_spaces > few_half_spaces) {
                const Box known = inflated(part, margin_);
                in.size = local_size(*item.tree, known);
                if (in.size.side != Side::straddling) continue;
                if (in.size.half_spaces < item.size.half_spaces)
                    in.tree = std::make_shared<const SolidTree>(prune(*item.tree, known));
            }
            inside.push_back(std::move(in));
        }
        return inside;
    }

    // Splits the cell recursively, in parallel tasks where that pays; the result is the same.
    void split(Branch& to, const Box& cell, std::vector<BspItem> items, int depth, Patience patient) const {
        const BspCost here = cost_of(items);
        to.split = split_of(cell, items, here, depth, patient);
        if (to.split.axis < 0) {
            make_cell(to, cell, items);
            return;
        }
        const auto part = [&](int upper) { return half_of(cell, to.split.axis, to.split.position, upper); };
        std::vector<BspItem> inside[2];
        const auto half = [&](int upper) { inside[upper] = items_in(part(upper), items); };
        const auto descend = [&](int upper) {
            to.child[upper] = std::make_unique<Branch>();
            split(*to.child[upper], part(upper), std::move(inside[upper]), depth + 1, patient);
        };
        if (here.half_spaces < half_spaces_of_a_task) {
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

    // Moves the subtree's nodes, cells and local solids to bsp_; throws the first error of a cell in the tree's order.
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

    void make_cell(Branch& to, const Box& cell, const std::vector<BspItem>& items) const try {
        const Box known = inflated(cell, margin_);
        for (const BspItem& item : items) {
            const SolidTree local = prune(*item.tree, known);
            LocalSolid solid(item.solid, local, known, bsp_.tolerances, root_method_);
            if (solid.has_surface()) to.locals.push_back(std::move(solid));
        }
    } catch (const std::bad_alloc&) {
        throw;  // at once, since other cells will lack memory, too
    } catch (...) {
        to.error = std::current_exception();  // lay_out() throws the first one in the tree's order
    }

    RootMethod root_method_;
    double min_scale_;
    ExpectedRays rays_;
    BspTree bsp_;
    Box bounds_;                   // of the bounded solids, or of all planes' offsets if there are none
    double coordinate_bound_ = 0;  // largest |offset| of a plane
    BspSplitter splitter_;
    double margin_ = 0;
    int max_depth_ = 0;
};

}  // namespace

BspTree build_bsp(const std::vector<Solid>& solids, RootMethod root_method, double min_scale, ExpectedRays rays) {
    return Builder(root_method, min_scale, rays).run(solids);
}

}  // namespace deburr
