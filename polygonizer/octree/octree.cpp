#include "polygonizer/octree/octree.hpp"

#include <algorithm>

#include "bounds/bounding_box.hpp"
#include "polygonizer/mesh/repair.hpp"
#include "polygonizer/mesh/sharp_parts.hpp"
#include "polygonizer/mesh/untangle.hpp"
#include "polygonizer/octree/octree_mending.hpp"
#include "polygonizer/octree/octree_polygonization.hpp"

namespace deburr {
namespace {

bool is_within(const Box& a, const Box& b) { return a.empty() || (b.contains(a.lo) && b.contains(a.hi)); }

/// The solid intersected with the box.
SolidTree cut_off(SolidTree solid, const Box& box) {
    SolidTree wall = flatten(Solid::sharp(Density::box(box.lo, box.hi)));
    const int root = solid.root();
    solid.leaves.push_back(std::move(wall.leaves[0]));
    solid.leaves.back().material = solid.leaves[0].material;
    solid.nodes.push_back({SolidOp::leaf, int(solid.leaves.size()) - 1});
    solid.nodes.push_back({SolidOp::intersect, root, root + 1});
    return solid;
}

// The solid within the box; a tree without leaves if there is nothing in it.
SolidTree part_within(const SolidTree& mixed, const Box& box) {
    if (box.empty()) return {};
    SolidTree solid = separate_sharp(mixed);
    if (!solid.leaves.empty() && !is_within(bounding_box(solid), box)) return cut_off(std::move(solid), box);
    return solid;
}

double edge_of(const OctreeOptions& options, const SolidTree& solid, const Box& box) {
    return options.edge > 0 ? options.edge : octree_edge(solid, box);
}

}  // namespace

double octree_edge(const SolidTree& solid, const Box& box) {
    const double longest = largest(box.hi - box.lo), radius = solid.min_radius();
    return radius > 0 ? std::clamp(0.5 * radius, longest / 512, longest / 64) : longest / 64;
}

void check_octree_cells(const SolidTree& mixed, const Box& box, const OctreeOptions& options) {
    const SolidTree solid = part_within(mixed, box);
    if (!solid.leaves.empty())
        CellTree(solid, box, edge_of(options, solid, box), spare_levels, options.cancel, options.max_open_cells);
}

Mesh octree(const SolidTree& mixed, const Box& box, const OctreeOptions& options, OctreeStatistics* statistics) {
    const SolidTree solid = part_within(mixed, box);
    if (solid.leaves.empty()) return {};
    const double edge = edge_of(options, solid, box);
    SolidTree numbered = solid;
    for (std::size_t k = 0; k < numbered.leaves.size(); ++k) numbered.leaves[k].line = int(k);
    OctreeStatistics own;
    if (!statistics) statistics = &own;
    *statistics = {};
    OctreePolygonization polygonization(numbered, box, options, edge);
    MendedMesh best;
    // Facets that repair cannot help need smaller cells around them. Sharp walls part at last, however thin; where
    // rounded surfaces taper to a contact, smaller cells leave as many facets that cross.
    const int max_mending_rounds = solid.min_radius() > 0 || solid.has_free_form() ? 4 : 8;
    constexpr double worth_another = 0.8;
    for (int round = 0; round < max_mending_rounds; ++round) {
        std::vector<Origin> origins;
        Mesh mesh = polygonization.run(*statistics, origins);
        const FacetJudge judge(solid, mesh);
        MendedMesh now = mended(std::move(mesh), std::move(origins), judge, infinity, options.cancel);
        // Where surfaces touch, smaller cells leave as many faults.
        const bool helped = now.others > 0 || double(now.leaning) < worth_another * double(best.leaning);
        const bool more = helped && !now.wrong.empty() && polygonization.cut_around(now.mesh, now.wrong);
        if (now.is_better_than(best)) best = std::move(now);
        if (!more) break;
    }
    if (options.decimate && std::isfinite(options.tolerance))
        best = thinned_out(best, solid, options.tolerance, options.cancel, options.progress);
    if (!best.is_right()) {
        constexpr double in_edges = 0.25;
        untangle(best, FacetJudge(solid, best.mesh), in_edges * edge, options.cancel);
    }
    throw_unless_closed(best.mesh);
    return best.mesh;
}

}  // namespace deburr
