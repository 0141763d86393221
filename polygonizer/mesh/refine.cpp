#include "polygonizer/mesh/refine.hpp"

#include <algorithm>
#include <deque>

#include "bounds/sort_once.hpp"
#include "polygonizer/mesh/split_on_surface.hpp"

namespace deburr {
namespace {

// The greatest number of changes from a facet of the given mesh to one that may still be changed. Each split halves an
// edge and quarters its distance, so that any useful tolerance is met long before.
constexpr int max_generation = 24;

class Refinement {
public:
    Refinement(Mesh& mesh, std::vector<Origin>& origins, const FacetJudge& judge, double tolerance, CancelFlag cancel,
               const GoodFacets* good, Patches* patches)
        : facets_(mesh, origins, patches),
          judge_(judge),
          tolerance_(tolerance),
          cancel_(cancel),
          mesh_(mesh),
          good_(good) {
        generation_.resize(facets_.size(), 0);
        distances_.resize(facets_.size(), unknown_edges);
    }

    // Queues the facets of the given mesh that are far from the surface.
    void open_far() {
        std::vector<char> far(facets_.size(), false);
        // An edge's distance is found by the facet in which the edge runs to the greater vertex, and is then there for
        // the other facet.
        judge_in_parallel(judge_, facets_.size(), [&](const FacetJudge& judge, std::size_t first, std::size_t last) {
            for (std::size_t f = first; f < last; ++f) {
                if (f % 1024 == 0) throw_if_cancelled(cancel_);
                far[f] = facets_.at(int(f)).origin.leaf >= 0 && may_be_far(int(f));
                const auto& v = facets_.at(int(f)).triangle.vertex;
                for (std::size_t k = 0; far[f] && k < 3; ++k)
                    if (v[k] < v[(k + 1) % 3]) distances_[f][k] = edge_distance(judge, int(f), k);
            }
        });
        judge_in_parallel(judge_, facets_.size(), [&](const FacetJudge& judge, std::size_t first, std::size_t last) {
            Edge edges[3];
            for (std::size_t f = first; f < last; ++f) {
                if (f % 1024 == 0) throw_if_cancelled(cancel_);
                far[f] = far[f] && is_far(judge, int(f), edges);
            }
        });
        for (std::size_t f = 0; f < facets_.size(); ++f)
            if (far[f]) open_.push_back(int(f));
    }

    void open(std::span<const int> facets) { open_.assign(facets.begin(), facets.end()); }

    std::vector<int> run() {
        std::size_t looks = 0;
        while (!open_.empty()) {
            if (++looks % 1024 == 0) throw_if_cancelled(cancel_);
            const int f = open_.front();
            open_.pop_front();
            if (!facets_.alive(f) || facets_.at(f).origin.leaf < 0 || !is_far(f)) continue;
            if (generation_[f] >= max_generation || !improve(f)) stuck_.push_back(f);
        }
        std::vector<int> order(facets_.size(), -1), left;
        int t = 0;
        for (std::size_t f = 0; f < facets_.size(); ++f)
            if (facets_.alive(int(f))) order[f] = t++;
        // Other facets may have taken the place of some.
        sort_once(stuck_);
        for (const int f : stuck_)
            if (facets_.alive(f) && is_far(f)) left.push_back(order[f]);
        facets_.finish();
        return left;
    }

private:
    struct Edge {
        double distance, curvature;
        std::size_t k;
    };

    static constexpr double unknown = -1;
    static constexpr std::array<double, 3> unknown_edges{unknown, unknown, unknown};

    static double distance(const FacetJudge& judge, Vec3 x) { return std::abs(judge.solid().at(x).distance); }

    // The greatest distance of three points along the edge from the surface. The middle alone would not do: along an S
    // it is on the surface.
    static double distance(const FacetJudge& judge, Vec3 a, Vec3 b) {
        double farthest = 0;
        for (const double share : {0.25, 0.5, 0.75})
            farthest = std::max(farthest, distance(judge, a + share * (b - a)));
        return farthest;
    }

    // distance() of edge k of facet f. It is taken from the facet beyond the edge if that knows it, and otherwise
    // computed from the lesser vertex to the greater, so that both facets get the same bits.
    double edge_distance(const FacetJudge& judge, int f, std::size_t k) const {
        const auto& v = facets_.at(f).triangle.vertex;
        const int a = v[k], b = v[(k + 1) % 3];
        if (const int other = facets_.across(a, b); other >= 0) {
            const auto& beyond = facets_.at(other).triangle.vertex;
            for (std::size_t j = 0; j < 3; ++j)
                if (beyond[j] == b && beyond[(j + 1) % 3] == a && distances_[other][j] != unknown)
                    return distances_[other][j];
        }
        return distance(judge, facets_.position(std::min(a, b)), facets_.position(std::max(a, b)));
    }

    // False if the facet was found good, or is so small that it must be near the surface.
    bool may_be_far(int f) const {
        const Triangle& t = facets_.at(f).triangle;
        if (good_ && good_->has(mesh_, t, facets_.at(f).origin)) return false;
        Vec3 x[3];
        for (std::size_t k = 0; k < 3; ++k) x[k] = facets_.position(t.vertex[k]);
        // A triangle whose vertices are on the surface is nearer to it than its edges are long.
        const double longest = std::max({glm::length(x[0] - x[1]), glm::length(x[1] - x[2]), glm::length(x[2] - x[0])});
        return longest > 2 * tolerance_;
    }

    // Whether points of the facet are too far from the surface; then edges_ are its edges, ordered by how much they
    // need a vertex.
    bool is_far(int f) { return may_be_far(f) && is_far(judge_, f, edges_); }

    // The same for a facet that may be far, with the edges in `edges`. It finds those of its edges' distances that are
    // unknown.
    bool is_far(const FacetJudge& judge, int f, Edge (&edges)[3]) {
        for (std::size_t k = 0; k < 3; ++k)
            if (distances_[f][k] == unknown) distances_[f][k] = edge_distance(judge, f, k);
        const Triangle& t = facets_.at(f).triangle;
        Vec3 x[3], n[3];
        for (std::size_t k = 0; k < 3; ++k) {
            x[k] = facets_.position(t.vertex[k]);
            n[k] = facets_.normal(t.normal[k]);
        }
        double farthest = 0, max_turn = 0;
        std::size_t turns_most = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t l = (k + 1) % 3;
            const double d = distances_[f][k], length = glm::length(x[k] - x[l]);
            const double turn = glm::length(n[k] - n[l]) * length;
            farthest = std::max(farthest, d);
            edges[k] = {d, d / (length * length), k};
            if (turn <= max_turn) continue;
            max_turn = turn;
            turns_most = k;
        }
        if (farthest <= tolerance_) {
            const Vec3 middle = (x[0] + x[1] + x[2]) / 3.0;
            farthest = std::max(farthest, distance(judge, middle));
            for (std::size_t k = 0; k < 3 && farthest <= tolerance_; ++k)
                farthest = std::max(farthest, distance(judge, 0.5 * (x[k] + middle)));
        }
        if (farthest <= tolerance_) return false;
        // Where the middle is far from the surface and no edge is, the edge along which the normals turn most is taken.
        if (std::max({edges[0].distance, edges[1].distance, edges[2].distance}) < 0.5 * tolerance_)
            edges[turns_most].distance = farthest;
        std::sort(std::begin(edges), std::end(edges), [](const Edge& a, const Edge& b) {
            return a.curvature != b.curvature ? a.curvature > b.curvature : a.k < b.k;
        });
        return true;
    }

    // Replaces the edge by the other diagonal of its two facets if that is much nearer to the surface; returns whether
    // it did.
    bool flip(int f, const Edge& edge) {
        const Triangle& t = facets_.at(f).triangle;
        const int a = t.vertex[edge.k], b = t.vertex[(edge.k + 1) % 3], c = t.vertex[(edge.k + 2) % 3];
        const int other = facets_.across(a, b);
        int d = -1;
        for (const int v : facets_.at(other).triangle.vertex)
            if (v != a && v != b) d = v;
        constexpr double much = 0.5;
        const Vec3 from = facets_.position(c), to = facets_.position(d);
        for (const double share : {0.5, 0.25, 0.75})
            if (distance(judge_, from + share * (to - from)) >= much * edge.distance) return false;
        const auto change = facets_.flip(f, edge.k);
        return change && is_better(*change) && apply(*change);
    }

    bool apply(const Change& change) {
        struct KnownEdge {
            int a, b;
            double distance;
        };
        ShortList<KnownEdge, 6> known;
        int generation = 0;
        for (const int f : change.out) {
            generation = std::max(generation, generation_[f]);
            const auto& v = facets_.at(f).triangle.vertex;
            for (std::size_t k = 0; k < 3; ++k) known.push_back({v[k], v[(k + 1) % 3], distances_[f][k]});
        }
        for (const int fresh : facets_.apply(change)) {
            open_.push_back(fresh);
            generation_.resize(std::max(generation_.size(), std::size_t(fresh) + 1));
            distances_.resize(generation_.size());
            generation_[fresh] = generation + 1;
            distances_[fresh] = unknown_edges;
            const auto& v = facets_.at(fresh).triangle.vertex;
            for (std::size_t k = 0; k < 3; ++k)
                for (const KnownEdge& e : known)
                    if (e.a == v[k] && e.b == v[(k + 1) % 3]) distances_[fresh][k] = e.distance;
        }
        return true;
    }

    // Flips or splits one of the facet's edges that are far themselves, in order of curvature; false if nothing helped.
    bool improve(int f) {
        for (const Edge& edge : edges_)
            if (edge.distance > 0.5 * tolerance_ && flip(f, edge)) return true;
        for (const Edge& edge : edges_) {
            if (edge.distance <= 0.5 * tolerance_) continue;
            const auto change = split_on_surface(facets_, judge_, f, edge.k);
            if (change && is_better(*change)) return apply(*change);
        }
        return false;
    }

    // Whether the facet is so slender that it may lean while it stays near the surface.
    bool is_sliver(const Triangle& t) const {
        constexpr double slender = 0.2;  // height over longest side
        double longest2 = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 d = facets_.position(t.vertex[k]) - facets_.position(t.vertex[(k + 1) % 3]);
            longest2 = std::max(longest2, glm::dot(d, d));
        }
        return glm::length(facets_.area_vector(t)) < slender * longest2;
    }

    // Whether no new facet leans farther from its surface than the worst old one did, or all are upright. Slivers may
    // lean: those that a split raises are flipped or collapsed later.
    bool is_better(const Change& change) const {
        constexpr double upright = 0.5, sliver = 0.01;  // cosines
        double limit = upright;
        for (const int f : change.out) limit = std::min(limit, judge_.shape(facets_, facets_.at(f)).cosine);
        return std::all_of(change.in.begin(), change.in.end(), [&](const Facet& f) {
            const double cosine = judge_.shape(facets_, f).cosine;
            return cosine >= limit || (cosine >= sliver && is_sliver(f.triangle));
        });
    }

    Facets facets_;
    const FacetJudge& judge_;
    double tolerance_;
    CancelFlag cancel_;
    const Mesh& mesh_;
    const GoodFacets* good_;
    std::deque<int> open_;
    std::vector<int> generation_;                   // by facet: the number of changes that led to it
    std::vector<std::array<double, 3>> distances_;  // by facet and edge: distance(), or `unknown`
    std::vector<int> stuck_;
    Edge edges_[3];
};

}  // namespace

std::vector<int> refine(Mesh& mesh, std::vector<Origin>& origins, const FacetJudge& judge, double tolerance,
                        CancelFlag cancel, const GoodFacets* good, Patches* patches) {
    if (mesh.triangles.empty()) return {};
    Refinement refinement(mesh, origins, judge, tolerance, cancel, good, patches);
    refinement.open_far();
    return refinement.run();
}

std::vector<int> refine(Mesh& mesh, std::vector<Origin>& origins, std::span<const int> triangles,
                        const FacetJudge& judge, double tolerance, CancelFlag cancel, Patches* patches) {
    if (triangles.empty()) return {};
    Refinement refinement(mesh, origins, judge, tolerance, cancel, nullptr, patches);
    refinement.open(triangles);
    return refinement.run();
}

}  // namespace deburr
