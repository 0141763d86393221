#include "polygonizer/octree/octree.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "bounds/bounding_box.hpp"
#include "bounds/sort_once.hpp"
#include "polygonizer/mesh/repair.hpp"
#include "polygonizer/mesh/sharp_parts.hpp"
#include "polygonizer/mesh/untangle.hpp"
#include "polygonizer/octree/octree_hard_edges.hpp"
#include "polygonizer/octree/octree_linking.hpp"
#include "polygonizer/octree/octree_mending.hpp"
#include "polygonizer/octree/thin_features.hpp"

namespace deburr {
namespace {

constexpr double radians = 0.017453292519943295;
// How often a cell may be cut further than its level: for triangles that lean, and where they cross.
constexpr int max_rounds = 4, spare_levels = 6;
// Where a sheet is thinner than cells, smaller ones spread from where it is seen.
constexpr int max_thin_rounds = 8;
// Cosine between a triangle and the surface below which the cells around it are cut further: 75°.
constexpr double min_cosine = 0.25;
// The same for its distance, in lengths of its longest side: such a triangle closes what goes on.
constexpr double off = 0.45;
// A sliver leans for other reasons, which cutting does not help: repair.hpp.
constexpr double sliver = 0.005;  // height over longest side
// Points nearer than this, in cells, are one.
constexpr double same_place = 1e-6;
// Two triangles that face as their points do, to this cosine, are as good as two others.
constexpr double alike = 0.95;

bool is_within(const Box& a, const Box& b) { return a.empty() || (b.contains(a.lo) && b.contains(a.hi)); }

SolidTree cut_off(SolidTree solid, const Box& box) {
    SolidTree wall = flatten(Solid::sharp(Density::box(box.lo, box.hi)));
    const int root = solid.root();
    solid.leaves.push_back(std::move(wall.leaves[0]));
    solid.leaves.back().material = solid.leaves[0].material;
    solid.nodes.push_back({SolidOp::leaf, int(solid.leaves.size()) - 1});
    solid.nodes.push_back({SolidOp::intersect, root, root + 1});
    return solid;
}

// What is polygonized: without leaves if there is nothing.
SolidTree part_within(const SolidTree& mixed, const Box& box) {
    if (box.empty()) return {};
    SolidTree solid = separate_sharp(mixed);
    if (!solid.leaves.empty() && !is_within(bounding_box(solid), box)) return cut_off(std::move(solid), box);
    return solid;
}

double edge_of(const OctreeOptions& options, const SolidTree& solid, const Box& box) {
    return options.edge > 0 ? options.edge : octree_edge(solid, box);
}

// A triangle as it stands to the surface at its middle.
struct Standing {
    double cosine = 1, distance = 0;
};

class Polygonization {
public:
    Polygonization(const SolidTree& solid, const Box& box, const OctreeOptions& options, double edge)
        : options_(options),
          hard_cosine_(std::cos(options.hard_angle * radians)),
          tree_(solid, box, edge, spare_levels, options.cancel, options.max_open_cells),
          has_forms_(solid.has_free_form()),
          looks_for_thin_(has_forms_) {}

    Mesh run(OctreeStatistics& statistics, std::vector<Origin>& origins) {
        // Each halving of cells quarters distances; what leans still is left to repair.
        for (int round = 1;; ++round) {
            ++statistics.rounds;
            if (options_.progress) options_.progress->begin(0.5);
            linking_ = link(tree_);
            place_crossings();
            place_points();
            make_triangles();
            std::vector<int> leaves;
            // After repair, cells are cut further for thin forms only.
            if ((has_forms_ ? round : int(statistics.rounds)) <= max_rounds) find_leaning(leaves);
            bool changed = split(leaves);
            if (looks_for_thin_ && round <= max_thin_rounds) changed |= split_unseen(tree_, linking_, mesh_);
            if (!changed) break;
        }
        looks_for_thin_ = false;
        statistics.cells = statistics.open_cells = statistics.hard_points = 0;
        for (const OctreeCell& c : tree_.cells())
            if (c.children < 0) {
                ++statistics.cells;
                statistics.open_cells += c.open;
            }
        statistics.level = tree_.level();
        statistics.edge = tree_.edge();
        statistics.range_tests = tree_.range_tests;
        follow_hard_edges(mesh_, tree_, hard_cosine_);
        statistics.partitions = divide_hard_edges(mesh_, tree_, hard_cosine_);
        for (const SurfacePoint& p : mesh_.points) statistics.hard_points += p.hard();
        return mesh_.mesh(origins);
    }

    /// Cuts the cells around these triangles; false if they are as small as may be.
    bool cut_around(const Mesh& mesh, const std::vector<int>& triangles) {
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

private:
    bool split(std::vector<int>& leaves) {
        sort_once(leaves);
        bool changed = false;
        for (const int leaf : leaves)
            if (tree_.cell(leaf).open) changed |= tree_.split(leaf);
        return changed;
    }

    // Before one of `count` that are half of a round's work.
    void go_on(std::size_t count) {
        throw_if_cancelled(options_.cancel);
        constexpr int at_once = 256;
        if (options_.progress && ++gone_on_ % at_once == 0) options_.progress->advance(0.5 * at_once / double(count));
    }

    void place_crossings() {
        std::unordered_map<std::uint64_t, CrossingPoint> known = std::move(known_crossings_);
        known_crossings_.clear();
        crossings_.clear();
        for (const EdgeCrossing& x : linking_.crossings) {
            go_on(linking_.crossings.size());
            const std::uint64_t key =
                (std::uint64_t(x.lo[0]) | std::uint64_t(x.lo[1]) << 20 | std::uint64_t(x.lo[2]) << 40) * 4 +
                std::uint64_t(x.axis);
            const auto it = known.find(key);
            Vec3 lo = tree_.position(x.lo), hi = tree_.position(x.hi());
            CrossingPoint c{x.low_inside ? lo : hi, x.low_inside ? hi : lo, {}};
            if (it != known.end() && it->second.inside == c.inside && it->second.outside == c.outside) {
                c = it->second;
            } else {
                int leaf = x.leaves[0];
                for (const int other : x.leaves)
                    if (tree_.cell(other).open && !tree_.cell(leaf).open) leaf = other;
                c.position = surface_root(tree_.solid(tree_.cell(leaf)), c.inside, c.outside);
            }
            known_crossings_.emplace(key, c);
            crossings_.push_back(c);
        }
    }

    void place_points() {
        mesh_ = {};
        std::vector<CrossingPoint> around;
        std::vector<std::size_t> tips;  // that stick out of their cells
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
        // A tip is one cell's, its own if that has found it.
        for (const std::size_t i : tips) {
            const auto same = [&](const SurfacePoint& p) {
                return &p != &mesh_.points[i] && p.hard() &&
                       glm::length(p.position - mesh_.points[i].position) < same_place * tree_.edge();
            };
            if (std::any_of(mesh_.points.begin(), mesh_.points.end(), same))
                mesh_.points[i] = make_point(linking_.loops[i], false);
        }
    }

    // Points of the polygon around a crossing, outward; where an edge between loops is there twice,
    // with the point in its middle, and begun there.
    void polygon_around(int crossing, std::vector<int>& polygon, std::size_t& middles) {
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

    void make_triangles() {
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

    // The diagonal of a quadrilateral is from its first point. Where the edge between two larger cells
    // is crossed twice, because it has smaller ones on its sides, two quadrilaterals have a diagonal
    // in common; only one may take it.
    void choose_diagonal(std::vector<int>& q, int crossing) {
        if (!first_diagonal(q)) std::rotate(q.begin(), q.begin() + 1, q.end());
        const auto& leaves = linking_.crossings[crossing].leaves;
        const auto size = [&](std::size_t k) { return tree_.cell(leaves[k]).size; };
        if (size(0) == size(1) && size(1) == size(2) && size(2) == size(3)) return;
        if (diagonals_.insert(std::minmax(q[0], q[2])).second) return;
        std::rotate(q.begin(), q.begin() + 1, q.end());
        if (diagonals_.insert(std::minmax(q[0], q[2])).second) return;
        // Neither is free: the crossing itself is a point between them.
        const SignedDistance& solid = tree_.solid(crossings_[crossing].position);
        const int middle = int(mesh_.points.size());
        const Vec3 x = crossings_[crossing].position;
        mesh_.points.push_back({x, {face_of(solid, solid.at(x))}});
        q = {middle, q[0], q[1], q[2], q[3], q[0]};
    }

    Standing standing(const TriangleVertices& t) const {
        const Vec3 middle = mesh_.middle(t), area = mesh_.area_vector(t);
        const SurfaceSample o = tree_.solid(middle).at(middle);
        Standing s;
        const double size = glm::length(area);
        if (size > 0 && o.normal != Vec3(0.0)) s.cosine = glm::dot(area, o.normal) / size;
        s.distance = std::abs(o.distance);
        if (std::isfinite(o.distance)) return s;
        if (passes_near(middle, area))
            s.distance = options_.tolerance;
        else
            s.cosine = 0;  // so far off that the density is saturated
        return s;
    }

    // Whether the surface passes within the tolerance, on the normal of a triangle, where a density of a smaller radius
    // is saturated.
    bool passes_near(Vec3 middle, Vec3 area) const {
        const double size = glm::length(area);
        if (!std::isfinite(options_.tolerance) || !(size > 0)) return false;
        const bool in = tree_.solid(middle).inside(middle);
        const Vec3 beyond = middle + area * ((in ? options_.tolerance : -options_.tolerance) / size);
        return tree_.solid(beyond).inside(beyond) != in;
    }

    // Whether the points of a triangle say all there is to say about how it stands: smooth, and
    // facing as it does.
    double cosine_to_points(const TriangleVertices& t) const {
        const Vec3 area = mesh_.area_vector(t);
        double least = 1;
        for (const int v : t) {
            const SurfacePoint& p = mesh_.points[v];
            if (p.hard()) return -1;
            least = std::min(least, glm::dot(area, p.faces[0].normal));
        }
        return least / std::max(glm::length(area), std::numeric_limits<double>::min());
    }

    // Whether the diagonal from the first point of a quadrilateral is better than the other.
    bool first_diagonal(const std::vector<int>& q) const {
        const TriangleVertices t[4] = {{q[0], q[1], q[2]}, {q[0], q[2], q[3]}, {q[1], q[2], q[3]}, {q[1], q[3], q[0]}};
        double cosine[4];
        for (int k = 0; k < 4; ++k) cosine[k] = cosine_to_points(t[k]);
        if (*std::min_element(cosine, cosine + 4) > alike)
            return glm::length(mesh_.position(q[0]) - mesh_.position(q[2])) <=
                   glm::length(mesh_.position(q[1]) - mesh_.position(q[3]));
        Standing s[4];
        for (int k = 0; k < 4; ++k) s[k] = standing(t[k]);
        const double first = std::min(s[0].cosine, s[1].cosine), second = std::min(s[2].cosine, s[3].cosine);
        if (first < min_cosine || second < min_cosine) return first >= second;
        const double one = std::max(s[0].distance, s[1].distance), other = std::max(s[2].distance, s[3].distance);
        if (std::abs(one - other) > 1e-6 * tree_.edge()) return one < other;
        return glm::length(mesh_.position(q[0]) - mesh_.position(q[2])) <=
               glm::length(mesh_.position(q[1]) - mesh_.position(q[3]));
    }

    void find_leaning(std::vector<int>& leaves) const {
        for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
            const auto& triangle = mesh_.triangles[t];
            if (!std::isfinite(options_.tolerance) && cosine_to_points(triangle) > alike) continue;
            const Standing s = standing(triangle);
            double longest = 0;
            for (std::size_t k = 0; k < 3; ++k)
                longest =
                    std::max(longest, glm::length(mesh_.position(triangle[k]) - mesh_.position(triangle[(k + 1) % 3])));
            const bool leans =
                s.cosine < min_cosine && glm::length(mesh_.area_vector(triangle)) > sliver * longest * longest;
            if (!leans && s.distance <= std::min(options_.tolerance, has_forms_ ? off * longest : infinity)) continue;
            for (const int leaf : linking_.crossings[crossing_of_[t]].leaves) leaves.push_back(leaf);
        }
    }

    const OctreeOptions& options_;
    double hard_cosine_;
    CellTree tree_;
    bool has_forms_;
    // In the first run, of free forms; gaps between touching polyhedra taper to nothing.
    bool looks_for_thin_;
    int gone_on_ = 0;
    Linking linking_;
    std::multimap<int, int> doubles_at_;  // of crossings
    std::vector<CrossingPoint> crossings_;
    std::unordered_map<std::uint64_t, CrossingPoint> known_crossings_;
    PointMesh mesh_;
    std::vector<int> crossing_of_;             // of each triangle
    std::set<std::pair<int, int>> diagonals_;  // taken, where they may be asked for twice
};

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
    Polygonization polygonization(numbered, box, options, edge);
    MendedMesh best;
    // What repair cannot help needs smaller cells around it. Sharp walls part in the end, however thin; where rounded
    // surfaces taper to where they touch, smaller cells find as many that cross.
    const int max_mending_rounds = solid.min_radius() > 0 || solid.has_free_form() ? 4 : 8;
    constexpr double worth_another = 0.8;
    for (int round = 0; round < max_mending_rounds; ++round) {
        std::vector<Origin> origins;
        Mesh mesh = polygonization.run(*statistics, origins);
        const FacetJudge judge(solid, mesh);
        MendedMesh now = mended(std::move(mesh), std::move(origins), judge, infinity, options.cancel);
        // Where surfaces touch, smaller cells leave as many.
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
