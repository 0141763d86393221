#include "raytracer/model/united_shells.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "bounds/union_find.hpp"
#include "polygonizer/mesh/exact_orientation.hpp"
#include "polygonizer/mesh/triangle_tree.hpp"
#include "raytracer/model/exact_plane.hpp"

namespace deburr {
namespace {

using Corners = std::array<int, 3>;

int sign(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

struct Before {
    const std::vector<ExactPoint>* points;
    bool operator()(int a, int b) const { return comes_before((*points)[a], (*points)[b]); }
};

// A part of the surface: a facet, or what cuts have left of some in one plane.
struct Part {
    Corners corners{};  // in `points` if cut, else of the file's vertices; counter-clockwise along `axis`
    int cluster = -1;   // of facets in one plane that overlap
    int count = 1;      // how many face along the axis, less those that face the other way
};

class Arrangement {
public:
    Arrangement(const std::vector<Vec3>& vertices, const std::vector<Corners>& triangles)
        : vertices_(vertices), triangles_(triangles), mesh_(as_mesh()), tree_(mesh_), clusters_(triangles.size()) {
        for (const Vec3& v : vertices) scale_ = std::max(scale_, largest(v));
    }

    UnitedShells united(bool strict) {
        meet();
        cut();
        return kept(strict);
    }

private:
    struct Segment {
        int from, to;
    };

    Mesh as_mesh() const {
        Mesh mesh;
        mesh.positions = vertices_;
        for (const Corners& t : triangles_) mesh.triangles.push_back({t, {0, 0, 0}});
        return mesh;
    }

    Vec3 corner(int t, int k) const { return vertices_[triangles_[t][k]]; }

    // The file's vertex as an exact point, that others may be equal to.
    int exact(int vertex) {
        const auto [at, is_new] = exact_.try_emplace(vertex, -1);
        if (is_new) at->second = number_of(ExactPoint(vertices_[vertex]));
        return at->second;
    }

    int number_of(const ExactPoint& point) {
        points_.push_back(point);
        const auto [at, is_new] = known_.insert(int(points_.size()) - 1);
        if (!is_new) points_.pop_back();
        return *at;
    }

    // Where facets meet in more than an edge or a corner that they share.
    void meet() {
        segments_.resize(triangles_.size());
        met_.assign(triangles_.size(), false);
        for (int s = 0; s < int(triangles_.size()); ++s)
            tree_.visit(tree_.box(s), [&](int t) {
                if (t > s) meet(s, t);
                return true;
            });
    }

    void meet(int s, int t) {
        int side_of_s[3], side_of_t[3];
        sides(t, s, side_of_s);
        if (is_beyond(side_of_s)) return;
        sides(s, t, side_of_t);
        if (is_beyond(side_of_t)) return;
        int shared = 0;
        for (const int v : triangles_[s]) shared += std::count(triangles_[t].begin(), triangles_[t].end(), v) > 0;
        if (side_of_s[0] == 0 && side_of_s[1] == 0 && side_of_s[2] == 0) {
            if (overlap(s, t)) {
                clusters_.join(s, t);
                met_[s] = met_[t] = true;
            }
            return;
        }
        if (shared >= 2) return;
        if (shared == 1 && (is_beside(side_of_s) || is_beside(side_of_t))) return;
        // Two parts of the line in which their planes meet.
        const auto a = line_part(s, t, side_of_s), b = line_part(t, s, side_of_t);
        if (!a || !b) return;
        const Before before{&points_};
        const int from = before(a->from, b->from) ? b->from : a->from, to = before(a->to, b->to) ? a->to : b->to;
        if (before(to, from)) return;
        for (const int x : {s, t}) {
            // A corner of its own is there already.
            if (from == to && std::any_of(triangles_[x].begin(), triangles_[x].end(),
                                          [&](int v) { return exact_.contains(v) && exact_[v] == from; }))
                continue;
            segments_[x].push_back({from, to});
            met_[x] = true;
        }
    }

    // On which sides of the plane of one facet the corners of another lie.
    void sides(int plane, int of, int (&side)[3]) const {
        for (int k = 0; k < 3; ++k) {
            const int v = triangles_[of][k];
            const Corners& p = triangles_[plane];
            side[k] = std::find(p.begin(), p.end(), v) != p.end()
                          ? 0
                          : sign(deburr::orientation(vertices_[p[0]], vertices_[p[1]], vertices_[p[2]], vertices_[v]));
        }
    }

    // Whether there is nothing of a facet in the plane.
    static bool is_beyond(const int (&side)[3]) {
        return (side[0] > 0 && side[1] > 0 && side[2] > 0) || (side[0] < 0 && side[1] < 0 && side[2] < 0);
    }

    // Whether nothing but one corner is.
    static bool is_beside(const int (&side)[3]) {
        const int up = int(std::count(side, side + 3, 1)), down = int(std::count(side, side + 3, -1));
        return (up == 2 && down == 0) || (up == 0 && down == 2);
    }

    PlaneAxes axes(int t) const { return PlaneAxes(axis(t)); }
    int axis(int t) const {
        const Vec3 n = glm::abs(normal(t));
        return greatest_axis(n);
    }
    Vec3 normal(int t) const { return glm::cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0)); }

    Vec2 flat(int t, int k, PlaneAxes in) const { return {corner(t, k)[in.u], corner(t, k)[in.v]}; }

    // Whether the insides of two facets of one plane meet: if no edge of either parts them.
    bool overlap(int s, int t) const {
        const PlaneAxes in = axes(s);
        const auto parted = [&](int a, int b) {
            const int turn = sign(deburr::orientation(flat(a, 0, in), flat(a, 1, in), flat(a, 2, in)));
            for (int k = 0; k < 3; ++k) {
                int beyond = 0;
                for (int l = 0; l < 3; ++l)
                    beyond +=
                        turn * sign(deburr::orientation(flat(a, k, in), flat(a, (k + 1) % 3, in), flat(b, l, in))) <= 0;
                if (beyond == 3) return true;
            }
            return false;
        };
        return !parted(s, t) && !parted(t, s);
    }

    // The part of facet s that lies in the plane of t, from its first point to its last.
    std::optional<Segment> line_part(int s, int t, const int (&side)[3]) {
        std::vector<int> found;
        for (int k = 0; k < 3; ++k) {
            const int a = triangles_[s][k], b = triangles_[s][(k + 1) % 3];
            const int here = side[k], there = side[(k + 1) % 3];
            if (here == 0) found.push_back(exact(a));
            if (here * there >= 0) continue;
            // From the same end whichever facet of the edge asks.
            const int lo = exact(std::min(a, b)), hi = exact(std::max(a, b));
            const int p = exact(triangles_[t][0]), q = exact(triangles_[t][1]), r = exact(triangles_[t][2]);
            found.push_back(number_of(on_plane(points_[lo], points_[hi], points_[p], points_[q], points_[r])));
        }
        if (found.empty()) return std::nullopt;
        std::sort(found.begin(), found.end(), Before{&points_});
        return Segment{found.front(), found.back()};
    }

    // Facets that meet others are cut along all that they meet, those that overlap in one plane together.
    void cut() {
        std::map<int, std::vector<int>> members;
        for (int t = 0; t < int(triangles_.size()); ++t)
            if (met_[t])
                members[clusters_.find(t)].push_back(t);
            else
                parts_.push_back(whole(t));
        cut_begin_ = parts_.size();
        for (auto& [first, all] : members) {
            cut(all);
            members_.push_back(std::move(all));
        }
    }

    // Whole facets keep the file's numbers until all have exact ones.
    Part whole(int t) {
        const int k = axis(t);
        Corners c = triangles_[t];
        const bool faces_along = normal(t)[k] > 0;
        if (!faces_along) std::swap(c[1], c[2]);
        return {c, -1 - t, faces_along ? 1 : -1};
    }

    void cut(const std::vector<int>& all) {
        const int k = axis(all[0]);
        const PlaneAxes in(k);
        const auto number = [&](const ExactPoint& p) { return number_of(p); };
        struct Member {
            Corners corners;  // counter-clockwise
            int count;
        };
        std::vector<Member> facets;
        for (const int t : all) {
            Member m{{exact(triangles_[t][0]), exact(triangles_[t][1]), exact(triangles_[t][2])}, 1};
            if (turn(m.corners, in) < 0) {
                std::swap(m.corners[1], m.corners[2]);
                m.count = -1;
            }
            facets.push_back(m);
        }
        Corners first = facets[0].corners;
        constexpr double helper_scale = 32;  // at least of what helpers' coordinates are, in those of the facets
        if (all.size() > 1) {                // around all
            Vec2 lo(infinity), hi(-infinity);
            for (const int t : all)
                for (int c = 0; c < 3; ++c) {
                    lo = glm::min(lo, flat(t, c, in));
                    hi = glm::max(hi, flat(t, c, in));
                }
            const double width = hi.x - lo.x + hi.y - lo.y;
            const auto helper = [&](double u, double v) {
                Vec3 x(0.0);
                x[in.u] = u;
                x[in.v] = v;
                points_.emplace_back(x);
                return int(points_.size()) - 1;
            };
            first = {helper(lo.x - width, lo.y - width), helper(hi.x + 4 * width, lo.y - width),
                     helper(lo.x - width, hi.y + 4 * width)};
        }
        PlaneTriangulation cells(points_, number, in, all.size() > 1 ? helper_scale * scale_ : scale_, first[0],
                                 first[1], first[2]);
        for (const Member& m : facets)
            for (const int v : m.corners) cells.insert(v);
        for (const int t : all)
            for (const Segment& s : segments_[t]) {
                cells.insert(s.from);
                cells.insert(s.to);
            }
        for (const Member& m : facets)
            for (int c = 0; c < 3; ++c) cells.insert_edge(m.corners[c], m.corners[(c + 1) % 3]);
        for (const int t : all)
            for (const Segment& s : segments_[t]) cells.insert_edge(s.from, s.to);
        for (const Corners& c : cells.triangles()) {
            int count = 0;
            if (facets.size() == 1) {
                count = facets[0].count;
            } else {
                const ExactPoint middle = weighted(c, 1, 1);
                for (const Member& m : facets)
                    if (holds(m.corners, middle, in) > 0) count += m.count;
            }
            if (count != 0) parts_.push_back({c, int(members_.size()), count});
        }
    }

    int turn(const Corners& c, PlaneAxes in) const {
        return deburr::orientation(points_[c[0]], points_[c[1]], points_[c[2]], in, scale_);
    }

    // 1 within, 0 on the border, −1 outside.
    int holds(const Corners& c, const ExactPoint& x, PlaneAxes in) const {
        int least = 1;
        for (int k = 0; k < 3; ++k)
            least = std::min(least, deburr::orientation(points_[c[k]], points_[c[(k + 1) % 3]], x, in, scale_));
        return least;
    }

    // A point within.
    ExactPoint weighted(const Corners& c, int second, int third) const {
        std::array<mpq_class, 3> x;
        for (int k = 0; k < 3; ++k)
            x[k] = (points_[c[0]].x[k] + second * points_[c[1]].x[k] + third * points_[c[2]].x[k]) /
                   mpq_class(1 + second + third);
        return ExactPoint(std::move(x));
    }

    // Parts that hang together at edges of two lie between the same two places.
    std::vector<int> sheets() {
        struct HalfEdge {
            int lo, hi, part;
        };
        std::vector<HalfEdge> edges;
        for (std::size_t p = 0; p < parts_.size(); ++p)
            for (int k = 0; k < 3; ++k) {
                const auto [lo, hi] = std::minmax(parts_[p].corners[k], parts_[p].corners[(k + 1) % 3]);
                edges.push_back({lo, hi, int(p)});
            }
        std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
            return std::tie(a.lo, a.hi, a.part) < std::tie(b.lo, b.hi, b.part);
        });
        UnionFind joined(parts_.size());
        for (std::size_t i = 0; i < edges.size();) {
            std::size_t end = i + 1;
            while (end < edges.size() && edges[end].lo == edges[i].lo && edges[end].hi == edges[i].hi) ++end;
            if (end - i == 2) joined.join(edges[i].part, edges[i + 1].part);
            i = end;
        }
        std::vector<int> sheet;
        for (std::size_t p = 0; p < parts_.size(); ++p) sheet.push_back(joined.find(int(p)));
        return sheet;
    }

    int axis_of(const Part& p) const { return axis(p.cluster < 0 ? -1 - p.cluster : members_[p.cluster][0]); }

    // How often the surface winds around what lies on the part's side along its axis.
    int winding(const Part& p) {
        const int k = axis_of(p);
        const PlaneAxes in(k);
        const int own = p.cluster < 0 ? -1 - p.cluster : -1;
        const std::vector<int> none, &cluster = p.cluster < 0 ? none : members_[p.cluster];
        // Through a point that lies on no edge, seen along the axis; another one where it does.
        for (int attempt = 1;; ++attempt) {
            const ExactPoint x = weighted(p.corners, attempt, 3 * attempt * attempt + 2);
            Box box{x.near, x.near};
            box = inflated(box, 4 * epsilon * scale_);
            box.hi[k] = infinity;
            int sum = 0;
            bool is_clear = true;
            tree_.visit(box, [&](int t) {
                if (t == own || std::binary_search(cluster.begin(), cluster.end(), t)) return true;
                Corners c{exact(triangles_[t][0]), exact(triangles_[t][1]), exact(triangles_[t][2])};
                const int way = turn(c, in);
                if (way < 0) std::swap(c[1], c[2]);
                const int within = holds(c, x, in);
                if (within == 0) is_clear = false;
                if (way == 0 || within <= 0) return is_clear;
                // Seen from above the corners run counter-clockwise.
                const int above = deburr::orientation(points_[c[0]], points_[c[1]], points_[c[2]], x, scale_);
                if (above < 0) sum += way;
                return true;
            });
            if (is_clear) return sum;
        }
    }

    UnitedShells kept(bool strict) {
        for (std::size_t p = 0; p < cut_begin_; ++p)
            for (int& v : parts_[p].corners) v = exact(v);
        const std::vector<int> sheet = sheets();
        UnitedShells result;
        std::map<int, int> vertex;
        std::size_t inside_out = 0;
        Vec3 place(0.0);
        // The sides of a sheet's parts by which way the surface faces, for their axes differ.
        std::map<int, std::pair<int, int>> sides;  // in front, behind
        for (std::size_t i = 0; i < parts_.size(); ++i) {
            const Part& p = parts_[i];
            const auto [at, is_new] = sides.try_emplace(sheet[i]);
            if (is_new) {
                const int w = winding(p);
                at->second = p.count > 0 ? std::pair(w, w + p.count) : std::pair(w + p.count, w);
            }
            const auto [front, behind] = at->second;
            if (std::min(front, behind) < 0 && inside_out++ == 0) place = weighted(p.corners, 1, 1).near;
            if ((front >= 1) == (behind >= 1)) continue;
            Corners c = p.corners;
            if (p.count < 0) std::swap(c[1], c[2]);
            for (int& v : c) {
                const auto [to, added] = vertex.try_emplace(v, int(result.vertices.size()));
                if (added) result.vertices.push_back(points_[v].near);
                v = to->second;
            }
            result.triangles.push_back(c);
        }
        if (strict && inside_out > 0) throw InsideOut(inside_out, place);
        return result;
    }

    const std::vector<Vec3>& vertices_;
    const std::vector<Corners>& triangles_;
    const Mesh mesh_;
    const TriangleTree tree_;
    UnionFind clusters_;
    double scale_ = 0;
    std::vector<char> met_;
    std::vector<std::vector<Segment>> segments_;  // of each facet
    std::vector<ExactPoint> points_;
    std::set<int, Before> known_{Before{&points_}};
    std::map<int, int> exact_;  // of the file's vertices
    std::vector<Part> parts_;
    std::size_t cut_begin_ = 0;
    std::vector<std::vector<int>> members_;  // of clusters, in rising order
};

}  // namespace

UnitedShells united_shells(const std::vector<Vec3>& vertices, const std::vector<Corners>& triangles, bool strict) {
    return Arrangement(vertices, triangles).united(strict);
}

}  // namespace deburr
