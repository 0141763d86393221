#include "polygonizer/mesh/edge_collapses.hpp"

#include <algorithm>

#include "polygonizer/mesh/split_on_surface.hpp"
#include "polygonizer/mesh/vertex_constraints.hpp"

namespace deburr {
namespace {

// The least ratio of height to longest side that a collapse may leave of curved facets, unless they were thinner
// before.
constexpr double slender = 0.02;
// The most facets around a vertex: beyond that a collapse makes the mesh harder to work with.
constexpr std::size_t max_fan = 20;

// A facet around a vertex, represented by its edge opposite to the vertex.
struct Opposite {
    int va, vb;       // ends of the edge
    Vec3 a, b, area;  // their positions, and the facet's area vector
};

// The distance from x to the triangle abc, whose area vector is given, or `enough` if the distance is not less than
// that.
double distance_to_triangle(Vec3 x, Vec3 a, Vec3 b, Vec3 c, Vec3 area, double enough) {
    const double size = glm::length(area);
    if (size > 0) {
        const double from_plane = std::abs(glm::dot(area, x - a)) / size;
        if (from_plane >= enough) return enough;
        if (glm::dot(glm::cross(b - a, x - a), area) >= 0 && glm::dot(glm::cross(c - b, x - b), area) >= 0 &&
            glm::dot(glm::cross(a - c, x - c), area) >= 0)
            return from_plane;
    }
    return std::min({enough, distance_to_segment(x, a, b), distance_to_segment(x, b, c), distance_to_segment(x, c, a)});
}

class EdgeCollapses {
public:
    EdgeCollapses(Mesh& mesh, std::vector<Origin>& origins, const FacetJudge& judge, double tolerance,
                  const CollapseOptions& options)
        : facets_(mesh, origins),
          constraints_(facets_, options.border, options.dense),
          judge_(judge),
          tolerance_(tolerance),
          options_(options),
          left_(mesh.triangles.size()),
          first_(mesh.positions.size(), options.around.empty()) {
        for (std::size_t f = 0; f < facets_.size() && !options.around.empty(); ++f) {
            const auto& t = facets_.at(int(f)).triangle.vertex;
            if (std::ranges::any_of(t, [&](int v) { return bool(options.around[v]); }))
                for (const int v : t) first_[v] = true;
        }
    }

    std::size_t run() {
        // First only cheap collapses, so that more are possible afterwards.
        std::size_t gone = 0;
        for (const double share : {0.1, 1.0}) {
            changed_ = first_;
            changed_.resize(std::size_t(facets_.vertices()), true);
            constexpr int max_rounds = 6;
            for (int round = 0; round < max_rounds; ++round) {
                const std::size_t now = pass(share * tolerance_, round == 0 ? 0.5 * options_.share_of_phase : 0);
                gone += now;
                if (100 * now < std::size_t(facets_.vertices())) break;
            }
        }
        return gone;
    }
    void finish(std::vector<int>* vertices, std::vector<int>* normals) { facets_.finish(vertices, normals); }

private:
    /// A place for a vertex to go to.
    struct Candidate {
        double error;           // distance of the removed vertex from the new facets
        int to;                 // the neighbour
        bool half_way = false;  // both ends of the edge go to the surface near its middle
        Vec3 x{0.0};            // half_way: the new vertex
    };
    std::size_t pass(double tolerance, double share_of_phase) {
        constexpr int at_once = 1024;
        std::size_t gone = 0;
        for (int v = 0; v < facets_.vertices(); ++v) {
            if (v % at_once == 0) {
                throw_if_cancelled(options_.cancel);
                if (options_.progress && share_of_phase > 0)
                    options_.progress->advance(share_of_phase * at_once / facets_.vertices());
            }
            if (left_ <= options_.enough) break;
            if (!changed_[v] || facets_.around(v).empty()) continue;
            changed_[v] = false;
            if (find_candidates(v, tolerance)) gone += collapse(v, tolerance);
        }
        return gone;
    }

    // Finds the places to which v may go, in order of error; false if v must stay.
    bool find_candidates(int v, double tolerance) {
        candidates_.clear();
        const VertexConstraint& kept = constraints_.at(v);
        if (kept.fixed) return false;
        planes_ = kept.planes.size();
        find_opposite(v, opposite_);
        const Vec3 x = facets_.position(v);
        for (const int f : facets_.around(v)) {
            const int to = facets_.at(f).triangle.vertex[(facets_.corner_index(f, v) + 1) % 3];
            if (constraints_.is_on_border(to)) continue;
            if (!kept.line_ends.empty() && to != kept.line_ends[0] && to != kept.line_ends[1]) continue;
            const Vec3 d = facets_.position(to) - x;
            const auto leaves = [&](Vec3 plane) { return std::abs(glm::dot(plane, d)) > 1e-9 * judge_.size(); };
            if (std::any_of(kept.planes.begin(), kept.planes.end(), leaves)) continue;
            const double error = this->error(opposite_, to, x, facets_.position(to));
            if (error <= tolerance) candidates_.push_back({error, to});
            offer_half_way(v, to, kept, tolerance);
        }
        std::sort(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
            return a.error != b.error ? a.error < b.error : a.to != b.to ? a.to < b.to : a.half_way < b.half_way;
        });
        return !candidates_.empty();
    }

    // Offers the middle of the edge from v to `to`, if both vertices are equally free.
    void offer_half_way(int v, int to, const VertexConstraint& kept, double tolerance) {
        if (to < v) return;  // it is offered from the other end
        const Vec3 a = facets_.position(v), b = facets_.position(to);
        Candidate c{0, to, true, 0.5 * (a + b)};
        // At the edge's middle, beside the surface, the error is not much greater than on the surface.
        c.error = error(opposite_, to, a, c.x);
        if (c.error > 2 * tolerance) return;
        const VertexConstraint& other = constraints_.at(to);
        if (other.fixed || other.planes.size() != kept.planes.size() || other.line_ends.size() != kept.line_ends.size())
            return;
        if (!other.line_ends.empty() && other.line_ends[0] != v && other.line_ends[1] != v) return;
        find_opposite(to, opposite_of_other_);
        c.error = std::max(c.error, error(opposite_of_other_, v, b, c.x));
        if (c.error <= 2 * tolerance) candidates_.push_back(c);
    }

    // Moves c.x, the middle of the edge from v to c.to, onto the surface; false if the edge's ends would then be too
    // far from the new facets.
    bool put_on_surface(int v, Candidate& c, double tolerance) {
        const Vec3 a = facets_.position(v), b = facets_.position(c.to);
        find_opposite(c.to, opposite_of_other_);
        pieces_.clear();
        const int f = facets_.across(v, c.to), g = facets_.across(c.to, v);
        add_surface(pieces_, surface_of(facets_, facets_.at(f)));
        add_surface(pieces_, surface_of(facets_, facets_.at(g)));
        return judge_.surfaces().project(c.x, pieces_, glm::length(b - a)) && judge_.on_surface(c.x) &&
               error(opposite_, c.to, a, c.x) <= tolerance && error(opposite_of_other_, v, b, c.x) <= tolerance;
    }

    /// Sets `edges` to the facets around v.
    void find_opposite(int v, std::vector<Opposite>& edges) const {
        edges.clear();
        for (const int f : facets_.around(v)) {
            const auto& vertex = facets_.at(f).triangle.vertex;
            const std::size_t k = std::size_t(facets_.corner_index(f, v));
            const int va = vertex[(k + 1) % 3], vb = vertex[(k + 2) % 3];
            const Vec3 x = facets_.position(v), a = facets_.position(va), b = facets_.position(vb);
            edges.push_back({va, vb, a, b, glm::cross(a - x, b - x)});
        }
    }

    // The distance of x, the position of a vertex, from the facets around it as they would be with the vertex at y;
    // facets at the vertex `to` are left out. Infinity if a facet would turn over.
    static double error(const std::vector<Opposite>& edges, int to, Vec3 x, Vec3 y) {
        double least = infinity;
        for (const Opposite& e : edges) {
            if (e.va == to || e.vb == to) continue;
            const Vec3 area = glm::cross(e.a - y, e.b - y);
            const double cosine = glm::dot(e.area, area);  // times both lengths
            if (cosine <= 0 || cosine * cosine <= 0.04 * glm::dot(e.area, e.area) * glm::dot(area, area))
                return infinity;
            least = distance_to_triangle(x, y, e.a, e.b, area, least);
        }
        return least;
    }

    // The change that merges both ends of the edge from v to `to` into the vertex `middle`.
    std::optional<Change> merge(int v, int to, int middle) {
        auto change = facets_.collapse(v, to);
        if (!change) return {};
        for (const int f : facets_.around(to))
            if (std::find(change->out.begin(), change->out.end(), f) == change->out.end()) {
                change->out.push_back(f);
                change->in.push_back(facets_.at(f));
            }
        const Vec3 x = facets_.position(middle);
        struct OfLeaf {
            int leaf, normal;
        };
        ShortList<OfLeaf, 4> normals;
        for (Facet& f : change->in) {
            const Vec3 flat = constraints_.flat_normal(f);
            for (std::size_t k = 0; k < 3; ++k) {
                if (f.triangle.vertex[k] != to) continue;
                f.triangle.vertex[k] = middle;
                if (flat != Vec3(0.0) || f.origin.leaf < 0) continue;
                int& n = f.triangle.normal[k];
                const auto known = std::find_if(normals.begin(), normals.end(),
                                                [&](const OfLeaf& o) { return o.leaf == f.origin.leaf; });
                if (known != normals.end()) {
                    n = known->normal;
                    continue;
                }
                const Vec3 outward = judge_.surfaces().at({f.origin.leaf}, x).normal;
                n = facets_.add_normal(glm::dot(outward, facets_.normal(n)) < 0 ? -outward : outward);
                normals.push_back({f.origin.leaf, n});
            }
        }
        return change;
    }

    bool collapse(int v, double tolerance) {
        constexpr std::size_t max_tries = 30;
        for (std::size_t k = 0; k < std::min(max_tries, candidates_.size()); ++k) {
            Candidate& c = candidates_[k];
            int to = c.to;
            std::optional<Change> change;
            if (c.half_way) {
                if (!put_on_surface(v, c, tolerance)) continue;
                if (spare_ < 0) {
                    spare_ = facets_.add_vertex(c.x);
                    changed_.resize(std::size_t(facets_.vertices()), true);
                }
                facets_.move(spare_, c.x);
                change = merge(v, to, spare_);
                to = spare_;
            } else {
                change = facets_.collapse(v, to);
            }
            if (!change || facets_.around(c.to).size() + change->in.size() > 2 + max_fan + 2 * planes_ * max_fan)
                continue;
            if (!accept(*change, v, to, tolerance)) continue;
            if (c.half_way) spare_ = -1;
            left_ -= change->out.size() - change->in.size();
            for (const int f : facets_.apply(*change)) {
                constraints_.update(f);
                changed_.resize(std::size_t(facets_.vertices()), true);
                for (const int u : facets_.at(f).triangle.vertex) changed_[u] = true;
            }
            return true;
        }
        return false;
    }

    /// Ratio of the triangle's height to its longest side, about.
    double slenderness(const Triangle& t) const {
        double longest2 = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 d = facets_.position(t.vertex[k]) - facets_.position(t.vertex[(k + 1) % 3]);
            longest2 = std::max(longest2, glm::dot(d, d));
        }
        return longest2 > 0 ? glm::length(facets_.area_vector(t)) / longest2 : 0;
    }

    // The other end of the longest edge at `to` that the change would add; −1 if it adds none.
    int longest_new_edge(const Change& change, int to) const {
        int other = -1;
        double longest2 = 0;
        for (const Facet& f : change.in) {
            const auto& t = f.triangle.vertex;
            const int next = t[(std::size_t(std::find(t.begin(), t.end(), to) - t.begin()) + 1) % 3];
            const Vec3 d = facets_.position(next) - facets_.position(to);
            if (glm::dot(d, d) <= longest2 || facets_.joined(to, next)) continue;
            longest2 = glm::dot(d, d);
            other = next;
        }
        return other;
    }

    // Whether the new facets around `to` are well shaped and near the surface. The cheapest tests come first.
    bool accept(const Change& change, int v, int to, double tolerance) const {
        if (v == to) return false;
        double thinnest = slender;
        for (const int f : change.out)
            if (constraints_.flat_normal(f) == Vec3(0.0))
                thinnest = std::min(thinnest, slenderness(facets_.at(f).triangle));
        for (const Facet& f : change.in)
            if (constraints_.flat_normal(f) == Vec3(0.0) && slenderness(f.triangle) < thinnest) return false;
        // The middle of the longest new edge is most often too far from the surface.
        const int longest = longest_new_edge(change, to);
        const Vec3 x = facets_.position(to);
        if (longest >= 0 && !judge_.is_near_between(x, facets_.position(longest), tolerance)) return false;
        for (const Facet& f : change.in) {
            const FacetShape s = judge_.shape(facets_, f, upright_after_collapse);
            if (s.cosine < upright_after_collapse || s.saturated || s.distance > tolerance) return false;
        }
        for (const Facet& f : change.in) {
            const auto& t = f.triangle.vertex;
            // The edge opposite to `to` is unchanged, and the edge before `to` is the next edge of another new facet,
            // or old.
            const std::size_t k = std::size_t(std::find(t.begin(), t.end(), to) - t.begin());
            const int next = t[(k + 1) % 3];
            const Vec3 a = facets_.position(next), b = facets_.position(t[(k + 2) % 3]);
            if (!judge_.is_near_within({x, a, b}, tolerance)) return false;
            if (next != longest && !facets_.joined(to, next) && !judge_.is_near_between(x, a, tolerance)) return false;
        }
        return true;
    }

    Facets facets_;
    VertexConstraints constraints_;
    const FacetJudge& judge_;
    double tolerance_;
    const CollapseOptions options_;
    std::size_t left_;         // triangles left
    std::vector<char> first_;  // vertices to be tried first
    // Working data of the vertex that is being tried.
    std::vector<Candidate> candidates_;
    std::vector<Opposite> opposite_, opposite_of_other_;
    std::vector<LeafSurface> pieces_;
    std::size_t planes_ = 0;
    std::vector<char> changed_;  // vertices whose facets have changed since they were last tried
    int spare_ = -1;             // a vertex without facets, for the next half-way candidate; −1: none
};

}  // namespace

std::size_t collapse_edges(Mesh& mesh, std::vector<Origin>& origins, const FacetJudge& judge, double tolerance,
                           const CollapseOptions& options, std::vector<int>* vertices, std::vector<int>* normals) {
    EdgeCollapses collapses(mesh, origins, judge, tolerance, options);
    const std::size_t gone = collapses.run();
    collapses.finish(vertices, normals);
    return gone;
}

}  // namespace deburr
