#include "polygonizer/triage/subdivision.hpp"

#include <algorithm>
#include <cassert>

#include "bounds/solid_range.hpp"
#include "polygonizer/triage/density_side.hpp"
#include "polygonizer/triage/parallel_family.hpp"

namespace deburr {

namespace {

// The planes of a field as a tree, to choose cuts from.
DensityTree planes_of(const Field& field) {
    DensityTree tree = DensityTree::constant(0);
    tree.half_spaces = field.planes();
    return tree;
}

}  // namespace

std::shared_ptr<const LocalDensity> Subdivision::density_of(const OpenLeaf& leaf) {
    return leaf.field ? std::make_shared<LocalDensity>(leaf.field) : std::make_shared<LocalDensity>(*leaf.tree);
}

Subdivision::Subdivision(const SolidTree& solid, const Box& box, const SubdivisionOptions& options)
    : complex(box, 1e-9 * glm::length(box.hi - box.lo)), options_(options) {
    PartitionNode whole;
    whole.solid = solid.nodes;
    for (std::size_t k = 0; k < solid.leaves.size(); ++k) {
        const SolidLeaf& leaf = solid.leaves[k];
        whole.open.push_back({int(k), std::make_shared<DensityTree>(leaf.field ? planes_of(*leaf.field) : leaf.density),
                              nullptr, leaf.field});
    }
    nodes.push_back(std::move(whole));
    refused_.emplace_back();
    node_of.push_back(0);
    node_of[0] = add_node(0, 0);
    subdivide(0);
}

// The range of corners_ along a normal.
Range Subdivision::extent(Vec3 normal) {
    for (const AlongNormal& e : along_normals_) {
        if (e.normal == normal) return e.along;
        if (e.normal == -normal) return {-e.along.hi, -e.along.lo};
    }
    const Range along = extent_along(normal, corners_);
    constexpr std::size_t usual = 8;  // more normals would take too long to search
    if (along_normals_.size() < usual) along_normals_.push_back({normal, along});
    return along;
}

// Rounding is monotone, so the least of the differences is the difference from the least.
Range Subdivision::distances(const HalfSpace& h) {
    const Range s = extent(h.normal);
    return {s.lo - h.offset, s.hi - h.offset};
}

// Sets ranges_ to the ranges of the half-spaces' densities over corners_.
void Subdivision::range_over_cell(const std::vector<HalfSpace>& half_spaces) {
    ranges_.clear();
    for (const HalfSpace& h : half_spaces) {
        const Range d = distances(h);
        ranges_.push_back(rho_between(h, d.lo, d.hi, complex.tolerance));
    }
}

// A rounded mesh in the current cell: a density of half-spaces as soon as few of its planes reach.
OpenLeaf Subdivision::localize_field(const OpenLeaf& leaf, Side& side) {
    Box box;
    for (const Vec3& x : corners_) box = hull(box, Box{x, x});
    // Triangles that touch the cell within rounding do not count; but vertices may lie beside it by as much.
    const Vec3 half = 0.5 * (box.hi - box.lo), slack = glm::min(Vec3(4 * complex.tolerance), half);
    const Box around = inflated(box, 4 * complex.tolerance);
    box = {box.lo + slack, box.hi - slack};
    OpenLeaf local = leaf;
    if (std::optional<DensityTree> density = leaf.field->as_density(box)) {
        local.field = nullptr;
        local.tree = std::make_shared<DensityTree>(std::move(*density));
        local.density = nullptr;
        return localize(local, side);
    }
    const Range f = leaf.field->range(box);
    side = classify_with_slack({f.lo + 0.5, f.hi + 0.5});
    if (side != Side::straddling) return local;
    if (FieldPtr left = leaf.field->prune(around)) {
        local.field = std::move(left);
        local.tree = std::make_shared<DensityTree>(planes_of(*local.field));
        local.density = nullptr;
    }
    if (!local.density && (leaf.density || local.tree->half_spaces.size() <= 2 * many))
        local.density = density_of(local);
    return local;
}

// The leaf in the current cell.
OpenLeaf Subdivision::localize(const OpenLeaf& leaf, Side& side) {
    if (leaf.field) return localize_field(leaf, side);
    range_over_cell(leaf.tree->half_spaces);
    Pruned pruned = prune_further(*leaf.tree, ranges_, is_classified_with_slack);
    side = classify_with_slack(pruned.range);
    if (side != Side::straddling) return leaf;
    OpenLeaf local = leaf;
    if (!pruned.tree.nodes.empty()) {
        local.tree = std::make_shared<DensityTree>(std::move(pruned.tree));
        local.density = nullptr;
    }
    // The leaf was evaluated in a cell around this one, so its local density is small enough here, too.
    if (!local.density && (leaf.density || local.tree->half_spaces.size() <= 2 * many))
        local.density = std::make_shared<LocalDensity>(*local.tree);
    if (local.density) {
        range_over_cell(local.density->half_spaces());
        side = classify_with_slack(local.density->range(ranges_));
        if (side == Side::straddling && is_parallel_family(*local.density)) {
            const Range s = extent(local.density->half_spaces()[0].normal);
            const auto roots = level_planes(*local.density, s, complex.tolerance);
            if (roots.planes.empty()) side = roots.inside ? Side::inside : Side::outside;
        }
    }
    return local;
}

void Subdivision::visit(int cell) {
    const std::pair now{cell, complex.cells.size()};
    if (visited_ == now) return;
    visited_ = now;
    corners_.clear();
    along_normals_.clear();
    for (int v : complex.vertices_of(cell)) corners_.push_back(complex.vertices[v]);
}

int Subdivision::add_node(int parent, int cell) {
    visit(cell);
    PartitionNode node;
    node.parent = parent;
    node.solid = nodes[parent].solid;
    for (const OpenLeaf& leaf : nodes[parent].open) {
        Side side;
        OpenLeaf local = localize(leaf, side);
        if (side == Side::straddling)
            node.open.push_back(std::move(local));
        else
            node.classified.push_back({leaf.leaf, side});
    }
    node.side = fold(node.solid, [&](int leaf) {
        for (const auto& [classified, side] : node.classified)
            if (classified == leaf) return side;
        return Side::straddling;
    });
    std::erase_if(node.open, [&](const OpenLeaf& leaf) {
        return std::none_of(node.solid.begin(), node.solid.end(),
                            [&](const SolidTreeNode& n) { return n.op == SolidOp::leaf && n.a == leaf.leaf; });
    });
    nodes.push_back(std::move(node));
    return int(nodes.size()) - 1;
}

Side Subdivision::side(int cell, int leaf) const {
    for (int p = node_of[cell]; p >= 0; p = nodes[p].parent) {
        const auto& classified = nodes[p].classified;
        const auto at = std::lower_bound(classified.begin(), classified.end(), std::pair{leaf, Side::outside});
        if (at != classified.end() && at->first == leaf) return at->second;
    }
    return Side::straddling;
}

const OpenLeaf* Subdivision::open(int cell, int leaf) const {
    for (const OpenLeaf& o : nodes[node_of[cell]].open)
        if (o.leaf == leaf) return &o;
    return nullptr;
}

bool Subdivision::halve(int cell, const Plane& plane) {
    if (nodes[node_of[cell]].side != Side::straddling) return false;
    const int upper = complex.cut(cell, plane);
    if (upper < 0) return false;
    const int parent = node_of[cell];
    refused_.push_back(refused_[cell]);
    node_of.push_back(add_node(parent, upper));
    node_of[cell] = add_node(parent, cell);
    // A node without a cell is only asked for its classified leaves, and its copies may be large.
    nodes[parent].open = {};
    nodes[parent].solid = {};
    return true;
}

void Subdivision::subdivide(int cell) {
    // A cell and the fraction of the work that it stands for; each half gets half of it.
    struct Task {
        int cell;
        double share;
    };
    std::vector<Task> todo{{cell, 1}};
    double done = 0;
    const auto finish = [&](double share) {
        constexpr double worth_a_word = 0.005;
        done += share;
        if (!options_.progress || done < worth_a_word) return;
        options_.progress->advance(done);
        done = 0;
    };
    for (std::size_t looks = 0; !todo.empty(); ++looks) {
        if (looks % 256 == 0) throw_if_cancelled(options_.cancel);
        const double share = todo.back().share;
        current_ = todo.back().cell;
        todo.pop_back();
        const int at = node_of[current_];
        if (nodes[at].side != Side::straddling) {
            finish(share);
            continue;
        }
        visit(current_);
        Plane plane{};
        if (!choose(nodes[at], plane)) {
            // Cells of a filter that reaches across the object stay large, with many half-spaces.
            for (OpenLeaf& leaf : nodes[at].open) {
                if (!leaf.density) leaf.density = density_of(leaf);
                left_ += 1 + leaf.tree->half_spaces.size();
            }
            if (left_ > options_.max_half_spaces) throw TooManyCells(complex.cells.size());
            finish(share);
            continue;
        }
        if (halve(current_, plane)) {
            todo.push_back({int(complex.cells.size()) - 1, 0.5 * share});
            todo.push_back({current_, 0.5 * share});
        } else {
            refused_[current_].push_back(plane);
            todo.push_back({current_, share});
        }
    }
}

}  // namespace deburr
