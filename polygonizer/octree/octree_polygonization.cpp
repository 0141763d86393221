#include "polygonizer/octree/octree_polygonization.hpp"

#include <algorithm>
#include <cmath>

#include "bounds/sort_once.hpp"
#include "polygonizer/octree/octree_hard_edges.hpp"
#include "polygonizer/octree/thin_features.hpp"

namespace deburr {
namespace {

// How often a cell may be cut further than its level: around triangles that lean, and where facets cross.
constexpr int max_rounds = 4;
// Where a sheet is thinner than cells, smaller cells spread from where it was found.
constexpr int max_thin_rounds = 8;
// Points nearer than this, in cells, are the same.
constexpr double same_place = 1e-6;

}  // namespace

OctreePolygonization::OctreePolygonization(const SolidTree& solid, const Box& box, const OctreeOptions& options,
                                           double edge)
    : options_(options),
      hard_cosine_(std::cos(options.hard_angle * (pi / 180))),
      tree_(solid, box, edge, spare_levels, options.cancel, options.max_open_cells),
      has_forms_(solid.has_free_form()),
      looks_for_thin_(has_forms_),
      leaning_(mesh_, tree_, options.tolerance, has_forms_) {}

Mesh OctreePolygonization::run(OctreeStatistics& statistics, std::vector<Origin>& origins) {
    refine(statistics);
    looks_for_thin_ = false;
    count_cells(statistics);
    follow_hard_edges(mesh_, tree_, hard_cosine_);
    statistics.partitions = divide_hard_edges(mesh_, tree_, hard_cosine_);
    statistics.hard_points = 0;
    for (const SurfacePoint& p : mesh_.points) statistics.hard_points += p.hard();
    return mesh_.mesh(origins);
}

// Makes the mesh and cuts cells around its faults, until there are none or cells are small enough.
void OctreePolygonization::refine(OctreeStatistics& statistics) {
    // Each halving of cells quarters distances; triangles that still lean are left to repair.
    for (int round = 1;; ++round) {
        ++statistics.rounds;
        if (options_.progress) options_.progress->begin(0.5);
        linking_ = link(tree_);
        place_crossings();
        place_points();
        make_triangles();
        std::vector<int> leaves;
        // After a repair, cells are cut further only for thin forms.
        if ((has_forms_ ? round : int(statistics.rounds)) <= max_rounds) find_leaning(leaves);
        bool changed = split(leaves);
        if (looks_for_thin_ && round <= max_thin_rounds) changed |= split_unseen(tree_, linking_, mesh_);
        if (!changed) break;
    }
}

void OctreePolygonization::count_cells(OctreeStatistics& statistics) const {
    statistics.cells = statistics.open_cells = 0;
    for (const OctreeCell& c : tree_.cells())
        if (c.children < 0) {
            ++statistics.cells;
            statistics.open_cells += c.open;
        }
    statistics.level = tree_.level();
    statistics.edge = tree_.edge();
    statistics.range_tests = tree_.range_tests;
}

bool OctreePolygonization::cut_around(const Mesh& mesh, const std::vector<int>& triangles) {
    std::vector<int> leaves;
    for (const int t : triangles) {
        Vec3 middle(0.0);
        for (const int v : mesh.triangles[t].vertex) {
            const Vec3 x = mesh.positions[v];
            middle += x / 3.0;
            leaves.push_back(tree_.find(x));
        }
        leaves.push_back(tree_.find(middle));
    }
    return split(leaves);
}

bool OctreePolygonization::split(std::vector<int>& leaves) {
    sort_once(leaves);
    bool changed = false;
    for (const int leaf : leaves)
        if (tree_.cell(leaf).open) changed |= tree_.split(leaf);
    return changed;
}

// Called before each of `count` steps that make up half of a round's work.
void OctreePolygonization::go_on(std::size_t count) {
    throw_if_cancelled(options_.cancel);
    constexpr int at_once = 256;
    if (options_.progress && ++gone_on_ % at_once == 0) options_.progress->advance(0.5 * at_once / double(count));
}

CrossingPoint OctreePolygonization::ends(const EdgeCrossing& x) const {
    const Vec3 lo = tree_.position(x.lo), hi = tree_.position(x.hi());
    return {x.low_inside ? lo : hi, x.low_inside ? hi : lo, {}};
}

// The point where the surface passes between the ends of the edge, evaluated in an open cell there.
Vec3 OctreePolygonization::place(const EdgeCrossing& x, const CrossingPoint& ends) const {
    int leaf = x.leaves[0];
    for (const int other : x.leaves)
        if (tree_.cell(other).open && !tree_.cell(leaf).open) leaf = other;
    return surface_root(tree_.solid(tree_.cell(leaf)), ends.inside, ends.outside);
}

/// Sets crossings_, reusing those of the last round.
void OctreePolygonization::place_crossings() {
    std::unordered_map<std::uint64_t, CrossingPoint> known = std::move(known_crossings_);
    known_crossings_.clear();
    crossings_.clear();
    for (const EdgeCrossing& x : linking_.crossings) {
        go_on(linking_.crossings.size());
        const std::uint64_t key =
            (std::uint64_t(x.lo[0]) | std::uint64_t(x.lo[1]) << 20 | std::uint64_t(x.lo[2]) << 40) * 4 +
            std::uint64_t(x.axis);
        CrossingPoint c = ends(x);
        const auto it = known.find(key);
        if (it != known.end() && it->second.inside == c.inside && it->second.outside == c.outside)
            c = it->second;
        else
            c.position = place(x, c);
        known_crossings_.emplace(key, c);
        crossings_.push_back(c);
    }
}

/// Puts a point into each loop.
void OctreePolygonization::place_points() {
    mesh_ = {};
    std::vector<CrossingPoint> around;
    std::vector<std::size_t> tips;  // points that stick out of their cells
    const auto make_point = [&](const Loop& loop, bool tip_may_stick_out) {
        around.clear();
        for (int i = loop.begin; i < loop.end; ++i) around.push_back(crossings_[linking_.around[i]]);
        const OctreeCell& cell = tree_.cell(loop.leaf);
        return surface_point(tree_.solid(cell), tree_.box(cell), around, hard_cosine_, tip_may_stick_out);
    };
    for (const Loop& loop : linking_.loops) {
        go_on(linking_.loops.size());
        mesh_.points.push_back(make_point(loop, true));
        if (!tree_.box(tree_.cell(loop.leaf)).contains(mesh_.points.back().position))
            tips.push_back(mesh_.points.size() - 1);
    }
    // A tip belongs to one cell: its own, if that has found it.
    for (const std::size_t i : tips) {
        const auto same = [&](const SurfacePoint& p) {
            return &p != &mesh_.points[i] && p.hard() &&
                   glm::length(p.position - mesh_.points[i].position) < same_place * tree_.edge();
        };
        if (std::any_of(mesh_.points.begin(), mesh_.points.end(), same))
            mesh_.points[i] = make_point(linking_.loops[i], false);
    }
}

// The points of the polygon around a crossing, counter-clockwise seen from outside. Where an edge between loops occurs
// twice, the point in its middle is inserted, and the polygon begins there.
void OctreePolygonization::polygon_around(int crossing, std::vector<int>& polygon, std::size_t& middles) {
    const EdgeCrossing& x = linking_.crossings[crossing];
    polygon.clear();
    middles = 0;
    for (std::size_t q = 0; q < 4; ++q) {
        const int from = x.loops[q], to = x.loops[(q + 1) % 4];
        if (from == to && x.leaves[q] == x.leaves[(q + 1) % 4]) continue;
        polygon.push_back(from);
        const auto [first, last] = doubles_at_.equal_range(crossing);
        for (auto d = first; d != last; ++d) {
            const DoubleSegment& s = linking_.doubles[d->second];
            if (std::minmax(s.loop_a, s.loop_b) != std::minmax(from, to)) continue;
            polygon.push_back(int(linking_.loops.size()) + d->second);
            ++middles;
        }
    }
    if (!x.low_inside) std::reverse(polygon.begin(), polygon.end());
    if (middles) {
        const auto first =
            std::find_if(polygon.begin(), polygon.end(), [&](int v) { return v >= int(linking_.loops.size()); });
        std::rotate(polygon.begin(), first, polygon.end());
    }
}

// Adds the middles of edges that occur twice, after the points of the loops.
void OctreePolygonization::add_middles_of_doubles() {
    doubles_at_.clear();
    for (std::size_t d = 0; d < linking_.doubles.size(); ++d)
        for (const int c : {linking_.doubles[d].crossing_a, linking_.doubles[d].crossing_b})
            doubles_at_.emplace(c, int(d));
    for (const DoubleSegment& s : linking_.doubles) {
        const CrossingPoint &a = crossings_[s.crossing_a], &b = crossings_[s.crossing_b];
        const Vec3 middle = 0.5 * (a.position + b.position);
        const SignedDistance& solid = tree_.solid(middle);
        const double reach = 0.5 * glm::length(a.position - b.position);
        const SurfaceSample o = solid.at(middle);
        const double distance = solid.distance_along_normal(middle, reach);
        SurfacePoint p{a.position, {}};
        if (std::isfinite(distance)) p.position = middle + o.normal * (o.distance > 0 ? distance : -distance);
        p.faces.push_back(face_of(solid, solid.at(p.position)));
        mesh_.points.push_back(p);
    }
}

void OctreePolygonization::make_triangles() {
    add_middles_of_doubles();
    crossing_of_.clear();
    diagonals_.clear();
    std::vector<int> polygon;
    std::size_t middles = 0;
    for (int c = 0; c < int(linking_.crossings.size()); ++c) {
        polygon_around(c, polygon, middles);
        if (polygon.size() == 4 && middles == 0) choose_diagonal(polygon, c);
        for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
            mesh_.triangles.push_back({polygon[0], polygon[k], polygon[k + 1]});
            crossing_of_.push_back(c);
        }
        ++mesh_.polygons;
    }
}

// Rotates a quadrilateral so that its diagonal is from its first point. Where the edge between two larger cells is
// crossed twice, because there are smaller cells beside it, two quadrilaterals have a diagonal in common, and only one
// may take it.
void OctreePolygonization::choose_diagonal(std::vector<int>& q, int crossing) {
    if (!leaning_.first_diagonal(q)) std::rotate(q.begin(), q.begin() + 1, q.end());
    const auto& leaves = linking_.crossings[crossing].leaves;
    const auto size = [&](std::size_t k) { return tree_.cell(leaves[k]).size; };
    if (size(0) == size(1) && size(1) == size(2) && size(2) == size(3)) return;
    if (diagonals_.insert(std::minmax(q[0], q[2])).second) return;
    std::rotate(q.begin(), q.begin() + 1, q.end());
    if (diagonals_.insert(std::minmax(q[0], q[2])).second) return;
    // Neither diagonal is free: the crossing itself becomes a point between them.
    const SignedDistance& solid = tree_.solid(crossings_[crossing].position);
    const int middle = int(mesh_.points.size());
    const Vec3 x = crossings_[crossing].position;
    mesh_.points.push_back({x, {face_of(solid, solid.at(x))}});
    q = {middle, q[0], q[1], q[2], q[3], q[0]};
}

void OctreePolygonization::find_leaning(std::vector<int>& leaves) const {
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
        if (leaning_.leans(mesh_.triangles[t]))
            for (const int leaf : linking_.crossings[crossing_of_[t]].leaves) leaves.push_back(leaf);
}

}  // namespace deburr
