#include "raytracer/model/united_shells.hpp"

#include <algorithm>
#include <map>
#include <optional>

#include "bounds/half_edges.hpp"
#include "bounds/union_find.hpp"
#include "polygonizer/mesh/triangle_tree.hpp"
#include "raytracer/model/exact_points.hpp"
#include "raytracer/model/facet_intersections.hpp"
#include "raytracer/model/triangle_surface.hpp"

namespace deburr {
namespace {

using Corners = std::array<int, 3>;

// A part of the surface: a whole facet, or a triangle that cutting the facets of one plane has left.
struct Part {
    Corners corners{};  // points if cut, else vertices of the file; counter-clockwise along the axis
    int cluster = -1;   // index of the facets in one plane, in members_; −1 − t: the whole facet t
    int count = 1;      // facets that face along the axis minus those that face the other way
};

// A facet to be cut, as seen along its plane's axis.
struct CutFacet {
    Corners corners;  // points, counter-clockwise
    int count;        // 1 if the facet faces along the axis, else −1
};

// The arrangement of a surface's facets: they are cut along their intersections, and the parts on the boundary are
// kept.
class Arrangement {
public:
    Arrangement(const std::vector<Vec3>& vertices, const std::vector<Corners>& triangles)
        : surface_{vertices, triangles},
          scale_(surface_.scale()),
          mesh_(surface_.mesh()),
          tree_(mesh_),
          points_(vertices),
          intersections_(surface_, tree_, points_) {}

    UnitedShells united(bool strict) {
        cut();
        return kept(strict);
    }

private:
    // Cuts the facets that meet others along all intersections; facets that overlap in one plane are cut together.
    void cut() {
        std::map<int, std::vector<int>> members;
        for (int t = 0; t < surface_.size(); ++t)
            if (intersections_.has_any(t))
                members[intersections_.cluster(t)].push_back(t);
            else
                parts_.push_back(whole(t));
        cut_begin_ = parts_.size();
        for (auto& [first, all] : members) {
            cut(all);
            members_.push_back(std::move(all));
        }
    }

    // A facet that is not cut. It keeps the file's numbers of vertices until all parts get exact points.
    Part whole(int t) const {
        const int k = surface_.axis(t);
        Corners c = surface_.triangles[t];
        const bool faces_along = surface_.normal(t)[k] > 0;
        if (!faces_along) std::swap(c[1], c[2]);
        return {c, -1 - t, faces_along ? 1 : -1};
    }

    // Cuts these facets, which lie in one plane.
    void cut(const std::vector<int>& all) {
        const PlaneAxes in = surface_.axes(all[0]);
        std::vector<CutFacet> facets;
        for (const int t : all) facets.push_back(cut_facet(t, in));
        for (const Corners& c : cells(all, facets, in)) {
            const int count = facets.size() == 1 ? facets[0].count : count_at(weighted(c, 1, 1), facets, in);
            if (count != 0) parts_.push_back({c, int(members_.size()), count});
        }
    }

    Corners exact_corners(int t) {
        const Corners& c = surface_.triangles[t];
        const int first = points_.of_vertex(c[0]), second = points_.of_vertex(c[1]);
        return {first, second, points_.of_vertex(c[2])};
    }

    CutFacet cut_facet(int t, PlaneAxes in) {
        CutFacet facet{exact_corners(t), 1};
        if (turn(facet.corners, in) < 0) {
            std::swap(facet.corners[1], facet.corners[2]);
            facet.count = -1;
        }
        return facet;
    }

    // The triangulation of one plane by the edges of these facets and by their intersections with others, as points.
    std::vector<Corners> cells(const std::vector<int>& all, const std::vector<CutFacet>& facets, PlaneAxes in) {
        // Upper bound of the coordinates of triangle_around(), relative to those of the facets.
        constexpr double scale_around = 32;
        const bool is_alone = all.size() == 1;
        const auto [a, b, c] = is_alone ? facets[0].corners : triangle_around(all, in);
        const auto number = [&](const ExactPoint& p) { return points_.number_of(p); };
        PlaneTriangulation cells(points_.all(), number, in, is_alone ? scale_ : scale_around * scale_, a, b, c);
        for (const CutFacet& facet : facets)
            for (const int v : facet.corners) cells.insert(v);
        for (const int t : all)
            for (const FacetIntersections::Segment& s : intersections_.segments(t)) {
                cells.insert(s.from);
                cells.insert(s.to);
            }
        for (const CutFacet& facet : facets)
            for (int k = 0; k < 3; ++k) cells.insert_edge(facet.corners[k], facet.corners[(k + 1) % 3]);
        for (const int t : all)
            for (const FacetIntersections::Segment& s : intersections_.segments(t)) cells.insert_edge(s.from, s.to);
        return cells.triangles();
    }

    // A triangle that contains all these facets.
    Corners triangle_around(const std::vector<int>& all, PlaneAxes in) {
        Vec2 lo(infinity), hi(-infinity);
        for (const int t : all)
            for (int k = 0; k < 3; ++k) {
                lo = glm::min(lo, surface_.flat(t, k, in));
                hi = glm::max(hi, surface_.flat(t, k, in));
            }
        const double width = hi.x - lo.x + hi.y - lo.y;
        const auto corner = [&](double u, double v) {
            Vec3 x(0.0);
            x[in.u] = u;
            x[in.v] = v;
            return points_.add(x);
        };
        return {corner(lo.x - width, lo.y - width), corner(hi.x + 4 * width, lo.y - width),
                corner(lo.x - width, hi.y + 4 * width)};
    }

    // The number of facets at x that face along the axis, minus those that face the other way.
    int count_at(const ExactPoint& x, const std::vector<CutFacet>& facets, PlaneAxes in) const {
        int count = 0;
        for (const CutFacet& facet : facets)
            if (holds(facet.corners, x, in) > 0) count += facet.count;
        return count;
    }

    int turn(const Corners& c, PlaneAxes in) const {
        return orientation(points_[c[0]], points_[c[1]], points_[c[2]], in, scale_);
    }

    // 1 if x is inside the triangle, 0 on its border, −1 outside.
    int holds(const Corners& c, const ExactPoint& x, PlaneAxes in) const {
        int least = 1;
        for (int k = 0; k < 3; ++k)
            least = std::min(least, orientation(points_[c[k]], points_[c[(k + 1) % 3]], x, in, scale_));
        return least;
    }

    // A point inside the triangle: the average of its corners with weights 1, `second` and `third`.
    ExactPoint weighted(const Corners& c, int second, int third) const {
        std::array<mpq_class, 3> x;
        for (int k = 0; k < 3; ++k)
            x[k] = (points_[c[0]].x[k] + second * points_[c[1]].x[k] + third * points_[c[2]].x[k]) /
                   mpq_class(1 + second + third);
        return ExactPoint(std::move(x));
    }

    // For each part the sheet that it belongs to: parts connected by edges that have exactly two of them, on each side
    // of which the winding number is the same.
    std::vector<int> sheets() {
        std::vector<std::array<int, 3>> corners;
        for (const Part& p : parts_) corners.push_back(p.corners);
        UnionFind joined(parts_.size());
        each_edge(sorted_half_edges(corners), [&](std::span<const HalfEdge> edge) {
            if (edge.size() == 2) joined.join(edge[0].triangle, edge[1].triangle);
        });
        std::vector<int> sheet;
        for (std::size_t p = 0; p < parts_.size(); ++p) sheet.push_back(joined.find(int(p)));
        return sheet;
    }

    int axis_of(const Part& p) const { return surface_.axis(p.cluster < 0 ? -1 - p.cluster : members_[p.cluster][0]); }

    // The winding number of the surface on the side of the part that its axis points to.
    int winding(const Part& p) {
        const int k = axis_of(p);
        const PlaneAxes in(k);
        const int own = p.cluster < 0 ? -1 - p.cluster : -1;
        const std::vector<int> none, &cluster = p.cluster < 0 ? none : members_[p.cluster];
        // Counts along a ray parallel to the axis, from a point of the part; if the ray meets an edge, another point is
        // tried.
        for (int attempt = 1;; ++attempt) {
            const ExactPoint x = weighted(p.corners, attempt, 3 * attempt * attempt + 2);
            Box box{x.near, x.near};
            box = inflated(box, 4 * epsilon * scale_);
            box.hi[k] = infinity;
            int sum = 0;
            bool is_clear = true;
            tree_.visit(box, [&](int t) {
                if (t == own || std::binary_search(cluster.begin(), cluster.end(), t)) return true;
                Corners c = exact_corners(t);
                const int way = turn(c, in);
                if (way < 0) std::swap(c[1], c[2]);
                const int within = holds(c, x, in);
                if (within == 0) is_clear = false;
                if (way == 0 || within <= 0) return is_clear;
                // The corners are counter-clockwise as seen from above.
                const int above = orientation(points_[c[0]], points_[c[1]], points_[c[2]], x, scale_);
                if (above < 0) sum += way;
                return true;
            });
            if (is_clear) return sum;
        }
    }

    // The winding numbers in front of a sheet and behind it.
    struct Sides {
        int front, behind;
    };

    Sides sides_of(const Part& p) {
        const int w = winding(p);
        return p.count > 0 ? Sides{w, w + p.count} : Sides{w + p.count, w};
    }

    // The parts with a winding number of at least 1 on exactly one side.
    UnitedShells kept(bool strict) {
        for (std::size_t p = 0; p < cut_begin_; ++p)
            for (int& v : parts_[p].corners) v = points_.of_vertex(v);
        const std::vector<int> sheet = sheets();
        UnitedShells result;
        std::map<int, int> vertex;
        std::size_t inside_out = 0;
        Vec3 place(0.0);
        // Indexed by sheet; in front and behind as the surface faces, since the axes of a sheet's parts differ.
        std::map<int, std::optional<Sides>> sides;
        for (std::size_t i = 0; i < parts_.size(); ++i) {
            const Part& p = parts_[i];
            std::optional<Sides>& known = sides[sheet[i]];
            if (!known) known = sides_of(p);
            const auto [front, behind] = *known;
            if (std::min(front, behind) < 0 && inside_out++ == 0) place = weighted(p.corners, 1, 1).near;
            if ((front >= 1) != (behind >= 1)) keep(p, vertex, result);
        }
        if (strict && inside_out > 0) throw InsideOut(inside_out, place);
        return result;
    }

    // Adds the part to the result; `vertex` maps points to their vertices there.
    void keep(const Part& p, std::map<int, int>& vertex, UnitedShells& result) const {
        Corners c = p.corners;
        if (p.count < 0) std::swap(c[1], c[2]);
        for (int& v : c) {
            const auto [to, added] = vertex.try_emplace(v, int(result.vertices.size()));
            if (added) result.vertices.push_back(points_[v].near);
            v = to->second;
        }
        result.triangles.push_back(c);
    }

    const TriangleSurface surface_;
    const double scale_;
    const Mesh mesh_;
    const TriangleTree tree_;
    ExactPoints points_;
    FacetIntersections intersections_;
    std::vector<Part> parts_;
    std::size_t cut_begin_ = 0;              // the parts before it are whole facets
    std::vector<std::vector<int>> members_;  // sorted facets of each plane that was cut
};

}  // namespace

UnitedShells united_shells(const std::vector<Vec3>& vertices, const std::vector<Corners>& triangles, bool strict) {
    return Arrangement(vertices, triangles).united(strict);
}

}  // namespace deburr
