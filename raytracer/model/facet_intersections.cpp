#include "raytracer/model/facet_intersections.hpp"

#include <algorithm>

#include "polygonizer/mesh/exact_orientation.hpp"

namespace deburr {
namespace {

using Corners = std::array<int, 3>;

// Whether a facet with its corners on these sides does not meet the plane.
bool is_beyond(const int (&side)[3]) {
    return (side[0] > 0 && side[1] > 0 && side[2] > 0) || (side[0] < 0 && side[1] < 0 && side[2] < 0);
}

// Whether it meets the plane in one corner only.
bool is_beside(const int (&side)[3]) {
    const int up = int(std::count(side, side + 3, 1)), down = int(std::count(side, side + 3, -1));
    return (up == 2 && down == 0) || (up == 0 && down == 2);
}

}  // namespace

FacetIntersections::FacetIntersections(const TriangleSurface& surface, const TriangleTree& tree, ExactPoints& points)
    : surface_(surface),
      points_(points),
      clusters_(surface.triangles.size()),
      met_(surface.triangles.size(), false),
      segments_(surface.triangles.size()) {
    for (int s = 0; s < surface.size(); ++s)
        tree.visit(tree.box(s), [&](int t) {
            if (t > s) meet(s, t);
            return true;
        });
}

void FacetIntersections::meet(int s, int t) {
    int side_of_s[3], side_of_t[3];
    sides(t, s, side_of_s);
    if (is_beyond(side_of_s)) return;
    sides(s, t, side_of_t);
    if (is_beyond(side_of_t)) return;
    int shared = 0;
    const Corners& corners = surface_.triangles[t];
    for (const int v : surface_.triangles[s]) shared += std::count(corners.begin(), corners.end(), v) > 0;
    if (side_of_s[0] == 0 && side_of_s[1] == 0 && side_of_s[2] == 0) {
        if (overlap(s, t)) {
            clusters_.join(s, t);
            met_[s] = met_[t] = true;
        }
        return;
    }
    if (shared >= 2) return;
    if (shared == 1 && (is_beside(side_of_s) || is_beside(side_of_t))) return;
    // The segments that both facets cut out of the line in which their planes meet.
    const auto a = line_part(s, t, side_of_s), b = line_part(t, s, side_of_t);
    if (!a || !b) return;
    const int from = points_.before(a->from, b->from) ? b->from : a->from;
    const int to = points_.before(a->to, b->to) ? a->to : b->to;
    if (points_.before(to, from)) return;
    for (const int x : {s, t}) {
        // A single point at one of the facet's own corners needs no cut.
        const Corners& own = surface_.triangles[x];
        const auto is_there = [&](int v) { return points_.is_vertex(v, from); };
        if (from == to && std::any_of(own.begin(), own.end(), is_there)) continue;
        segments_[x].push_back({from, to});
        met_[x] = true;
    }
}

// The sides of the plane of facet `plane` on which the corners of facet `of` lie; 0 for shared corners.
void FacetIntersections::sides(int plane, int of, int (&side)[3]) const {
    const std::vector<Vec3>& x = surface_.vertices;
    const Corners& p = surface_.triangles[plane];
    for (int k = 0; k < 3; ++k) {
        const int v = surface_.triangles[of][k];
        const bool is_shared = std::find(p.begin(), p.end(), v) != p.end();
        side[k] = is_shared ? 0 : sign_of(orientation(x[p[0]], x[p[1]], x[p[2]], x[v]));
    }
}

// Whether the interiors of two facets in one plane intersect, that is, no edge of either separates them.
bool FacetIntersections::overlap(int s, int t) const {
    const PlaneAxes in = surface_.axes(s);
    const auto flat = [&](int facet, int k) { return surface_.flat(facet, k % 3, in); };
    const auto parted = [&](int a, int b) {
        const int turn = sign_of(orientation(flat(a, 0), flat(a, 1), flat(a, 2)));
        for (int k = 0; k < 3; ++k) {
            int beyond = 0;
            for (int l = 0; l < 3; ++l)
                beyond += turn * sign_of(orientation(flat(a, k), flat(a, k + 1), flat(b, l))) <= 0;
            if (beyond == 3) return true;
        }
        return false;
    };
    return !parted(s, t) && !parted(t, s);
}

// The part of facet s that lies in the plane of t, from its first point to its last.
std::optional<FacetIntersections::Segment> FacetIntersections::line_part(int s, int t, const int (&side)[3]) {
    const Corners &own = surface_.triangles[s], &plane = surface_.triangles[t];
    std::vector<int> found;
    for (int k = 0; k < 3; ++k) {
        const int a = own[k], b = own[(k + 1) % 3];
        const int here = side[k], there = side[(k + 1) % 3];
        if (here == 0) found.push_back(points_.of_vertex(a));
        if (here * there >= 0) continue;
        // Computed from the same end for both facets of the edge, so that both get the same point.
        const int lo = points_.of_vertex(std::min(a, b)), hi = points_.of_vertex(std::max(a, b));
        const int p = points_.of_vertex(plane[0]), q = points_.of_vertex(plane[1]), r = points_.of_vertex(plane[2]);
        found.push_back(points_.number_of(on_plane(points_[lo], points_[hi], points_[p], points_[q], points_[r])));
    }
    if (found.empty()) return std::nullopt;
    std::sort(found.begin(), found.end(), [&](int a, int b) { return points_.before(a, b); });
    return Segment{found.front(), found.back()};
}

}  // namespace deburr
