#include "polygonizer/mesh/mesh_check.hpp"

#include <algorithm>
#include <map>
#include <queue>

#include "polygonizer/mesh/crossing_triangles.hpp"
#include "polygonizer/mesh/facet_judge.hpp"
#include "polygonizer/mesh/facet_orientation.hpp"

namespace deburr {
namespace {

// Number of facets between two checks of the cancel flag.
constexpr std::size_t check_interval = 4096;

class Check {
public:
    Check(const Mesh& mesh, const SolidTree& solid, const Box& box, const MeshCheckOptions& options)
        : mesh_(mesh), solid_(solid), box_(box), options_(options), tree_(mesh), field_(around(mesh, solid, box)) {
        for (const SolidLeaf& leaf : solid.leaves)
            for (const HalfSpace& h : leaf.density.half_spaces) radius_ = std::max(radius_, h.radius);
        size_ = largest(box.hi - box.lo);
        // A sharp surface is met by its mesh up to rounding.
        constexpr double of_size = 1e-6, of_radius = 0.5;
        const double wanted = std::isfinite(options.tolerance) ? options.tolerance : of_radius * radius_;
        tolerance_ = std::max({wanted, options.min_tolerance, of_size * size_});
    }

    MeshCheck run() {
        edges();
        crossings();
        facets();
        parts();
        for (MeshFault* fault : {&result_.open, &result_.inward, &result_.crossing, &result_.missing, &result_.added})
            if (fault->count > 0) fault->line = line_at(fault->location);
        return result_;
    }

private:
    static DistanceField around(const Mesh& mesh, const SolidTree& solid, const Box& box) {
        return DistanceField(solid, mesh.positions.empty() ? box : hull(box, field_box(mesh)),
                             facet_margin(mesh, solid));
    }

    Vec3 at(int v) const { return mesh_.positions[v]; }
    Vec3 middle(const Triangle& t) const { return (at(t.vertex[0]) + at(t.vertex[1]) + at(t.vertex[2])) / 3.0; }

    int line_at(Vec3 x) const {
        const SignedDistance& near = field_.near(x);
        const int leaf = near.at(x).leaf;
        return leaf >= 0 ? near.line(leaf) : solid_.leaves.empty() ? 0 : solid_.leaves[0].line;
    }

    void edges() {
        std::vector<std::pair<std::pair<int, int>, int>> edges;
        for (const Triangle& t : mesh_.triangles)
            for (std::size_t k = 0; k < 3; ++k) {
                const int a = t.vertex[k], b = t.vertex[(k + 1) % 3];
                edges.push_back({std::minmax(a, b), a < b ? 1 : -1});
            }
        std::sort(edges.begin(), edges.end());
        for (std::size_t k = 0, end; k < edges.size(); k = end) {
            int sum = 0;
            for (end = k; end < edges.size() && edges[end].first == edges[k].first; ++end) sum += edges[end].second;
            if (end - k != 2 || sum != 0)
                result_.open.add(0.5 * (at(edges[k].first.first) + at(edges[k].first.second)));
        }
    }

    void crossings() {
        for (const auto& [s, t] : crossing_triangles(mesh_, tree_, options_.cancel, &result_.pairs))
            result_.crossing.add(0.5 * (middle(mesh_.triangles[s]) + middle(mesh_.triangles[t])));
    }

    void facets() {
        // Facets whose height is below this fraction of their longest side count as having no area.
        constexpr double flat = 1e-9;
        double area_sum = 0;
        for (const Triangle& t : mesh_.triangles) area_sum += glm::length(mesh_.area_vector(t));
        const double area_each = area_sum / double(min_points + mesh_.triangles.size() / 4);
        for (const Triangle& t : mesh_.triangles) {
            if (result_.facets++ % check_interval == 0) throw_if_cancelled(options_.cancel);
            const Vec3 area = mesh_.area_vector(t), x = middle(t);
            double longest = 0;
            Vec3 normals(0.0);
            for (std::size_t k = 0; k < 3; ++k) {
                longest = std::max(longest, glm::distance(at(t.vertex[k]), at(t.vertex[(k + 1) % 3])));
                normals += mesh_.normals[t.normal[k]];
            }
            const double twice = glm::length(area);
            if (twice <= flat * longest * longest) continue;
            const Vec3 normal = area / twice;
            const SurfaceSample here = field_.at(x);
            const bool near = beside_surface(here, normal, x);
            if (!near && !options_.may_lean && !faces_outward(field_, x, here, normal, normals, longest))
                result_.inward.add(x);
            // Large facets are tested at more points: a part of the solid that a facet covers up need not be at its
            // middle.
            const std::size_t more = std::size_t(twice / area_each);
            for (std::size_t k = 1; k <= more; ++k) {
                const Vec3 y = point_of(t, k);
                beside_surface(field_.at(y), normal, y);
            }
        }
    }

    // The k-th of a facet's evenly spread points, by Roberts's sequence: multiples of powers of the plastic number,
    // folded into the triangle.
    Vec3 point_of(const Triangle& t, std::size_t k) const {
        constexpr double plastic = 1.32471795724474602596;
        double u = double(k) / plastic, v = double(k) / (plastic * plastic);
        u -= std::floor(u);
        v -= std::floor(v);
        if (u + v > 1) {
            u = 1 - u;
            v = 1 - v;
        }
        return (1 - u - v) * at(t.vertex[0]) + u * at(t.vertex[1]) + v * at(t.vertex[2]);
    }

    // Whether the surface is near x and faces as the facet does. If it is not near, points on both sides of x are
    // tested.
    bool beside_surface(const SurfaceSample& here, Vec3 normal, Vec3 x) {
        if (std::abs(here.distance) <= tolerance_) return glm::dot(normal, here.normal) > 0;
        judge(x - tolerance_ * normal, true);
        judge(x + tolerance_ * normal, false);
        return false;
    }

    // Whether x and everything within the tolerance is on one side of the surface, as far as six points tell.
    bool far_from_surface(Vec3 x, bool inside) const {
        for (int k = 0; k < 3; ++k)
            for (const double step : {-tolerance_, tolerance_}) {
                Vec3 y = x;
                y[k] += step;
                if (field_.inside(y) != inside) return false;
            }
        return true;
    }

    // Tests a point beside a facet. There the mesh's side is as expected unless another sheet of it is near, so the
    // winding number is needed only where the solid's side is not as expected.
    void judge(Vec3 x, bool expected) {
        ++result_.points;
        const bool inside = field_.inside(x);
        if (inside == expected) return;
        const std::optional<int> winding = tree_.winding(x);
        if (!winding || (*winding > 0) == inside || !far_from_surface(x, inside)) return;
        (inside ? result_.missing : result_.added).add(x);
    }

    // A part of the box, the solid pruned to it, and the number of halvings that made it.
    struct Cell {
        Box box;
        std::shared_ptr<const SignedDistance> solid;
        int depth;
    };

    // Tests the parts of the box. Cells without facets lie on one side of the mesh, so they must lie on one side of the
    // solid. Cells where the solid is undecided are halved, and so are cells with facets; first those where only one of
    // the two holds.
    void parts() {
        const std::size_t max_cells = min_cells + mesh_.triangles.size() / 8;
        std::queue<Cell> cells, doubtful;
        doubtful.push({box_, std::make_shared<const SignedDistance>(solid_), 0});
        for (std::size_t taken = 0; taken < max_cells && !(cells.empty() && doubtful.empty()); ++taken) {
            if (taken % 256 == 0) throw_if_cancelled(options_.cancel);
            std::queue<Cell>& from = doubtful.empty() ? cells : doubtful;
            const Cell cell = std::move(from.front());
            from.pop();
            const Vec3 middle = 0.5 * (cell.box.lo + cell.box.hi);
            for (const bool upper : {false, true}) {
                Cell half{cell.box, cell.solid, cell.depth + 1};
                const Vec3 size = cell.box.hi - cell.box.lo;
                const int axis = greatest_axis(size);
                (upper ? half.box.lo : half.box.hi)[axis] = middle[axis];
                visit(std::move(half), cells, doubtful);
            }
        }
    }

    void visit(Cell cell, std::queue<Cell>& cells, std::queue<Cell>& doubtful) {
        const bool passed = !tree_.visit(cell.box, [](int) { return false; });
        const bool decided = cell.solid->constant_side(cell.box) != 0;
        if (!passed) judge_part(0.5 * (cell.box.lo + cell.box.hi));
        if ((decided && !passed) || cell.depth >= max_depth) return;
        if (!decided && cell.depth % 3 == 0)
            cell.solid = std::make_shared<const SignedDistance>(cell.solid->within(cell.box));
        (decided == passed ? doubtful : cells).push(std::move(cell));
    }

    // Tests a cell without facets at x. A mesh without a tolerance may be far from the surface, but not without a facet
    // near it.
    void judge_part(Vec3 x) {
        ++result_.points;
        const bool inside = field_.inside(x);
        const std::optional<int> winding = tree_.winding(x);
        if (!winding || (*winding > 0) == inside) return;
        const bool missed = inside && !std::isfinite(options_.tolerance) &&
                            tree_.visit(inflated(Box{x, x}, std::max(radius_, tolerance_)), [](int) { return false; });
        if (missed || far_from_surface(x, inside)) (inside ? result_.missing : result_.added).add(x);
    }

    static constexpr int max_depth = 24;  // halvings of the box
    static constexpr std::size_t min_cells = 2000, min_points = 500;

    const Mesh& mesh_;
    const SolidTree& solid_;
    const Box box_;
    const MeshCheckOptions options_;
    const TriangleTree tree_;
    const DistanceField field_;
    double radius_ = 0, size_ = 0, tolerance_ = 0;
    MeshCheck result_;
};

}  // namespace

MeshCheck check_mesh(const Mesh& mesh, const SolidTree& solid, const Box& box, const MeshCheckOptions& options) {
    if (box.empty() && mesh.triangles.empty()) return {};
    return Check(mesh, solid, box, options).run();
}

}  // namespace deburr
