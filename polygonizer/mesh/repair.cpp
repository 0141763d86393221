#include "polygonizer/mesh/repair.hpp"

#include <algorithm>
#include <deque>
#include <optional>
#include <unordered_set>

#include "polygonizer/mesh/split_on_surface.hpp"

namespace deburr {
namespace {

// Limits of one stage of repair. A facet is wrong if the cosine between it and the surface at its middle is below
// `leaning`. The facets that replace it must reach `better`, and may be farther from the surface than it by the factor
// `farther`, or by `of_longest` of its longest side.
struct Limits {
    double leaning, better, farther, of_longest;
    double near;  // distance at which a surface counts as near, relative to the longest side
    bool unfold;  // whether collapses may leave more wrong facets if less of their area faces inward
};
// First all facets that lean are mended, then those that face inward, at any price.
constexpr Limits gentle{0.2, 0.25, 2, 1e-3, 0, false}, last_resort{0.05, 0.06, 5, 2e-2, 2e-2, true};
// Where surfaces are nearer to each other than any facet is small, mending one facet makes two that need it. So the
// numbers of splits and of tries are limited. The limit of splits grows with the number of wrong facets.
constexpr std::size_t max_splits = 80, more_splits = 8, splits_at_all = 4000, max_tries = 16;

// How good a set of facets is.
struct Verdict {
    int wrong = 0;
    double worst = 1, distance = 0;
    double inverted = 0;  // twice the area that faces inward
};

/// One repair of a mesh.
class Repair {
public:
    Repair(Mesh& mesh, std::vector<Origin>& origins, const FacetJudge& judge, double tolerance, Patches* patches)
        : facets_(mesh, origins, patches),
          judge_(judge),
          tolerance_(tolerance),
          solid_(judge.solid()),
          surfaces_(judge.surfaces()),
          shapes_(facets_.size()),
          changed_(facets_.size(), false),
          given_(facets_.size()),
          first_made_(facets_.vertices()) {}

    FacetShape shape(const Facet& f) const { return judge_.shape(facets_, f); }
    const FacetShape& shape(int f) {
        auto& known = shapes_[f];
        if (!known) known = shape(facets_.at(f));
        return *known;
    }
    bool wrong(int f) { return !is_good(f) && shape(f).cosine < limits_.leaning; }

    void add(Verdict& v, const Facet& f, const FacetShape& s, double limit) const {
        v.wrong += s.cosine < limit;
        v.worst = std::min(v.worst, s.cosine);
        v.distance = std::max(v.distance, s.distance);
        if (s.own < 0) v.inverted += glm::length(facets_.area_vector(f.triangle));
    }
    Verdict before(const Change& change) {
        Verdict v;
        for (const int f : change.out) add(v, facets_.at(f), shape(f), limits_.leaning);
        return v;
    }
    Verdict after(const Change& change) const {
        Verdict v;
        for (const Facet& f : change.in) add(v, f, shape(f), limits_.better);
        return v;
    }

    LeafSurface piece(const Facet& f) const { return surface_of(facets_, f); }

    // Moves vertex u onto v if v lies on all surfaces that meet at u, or is no farther than `near` from them, in the
    // last resort, so that facets may stand for either surface.
    std::optional<Change> collapse(int u, int v, double near) const {
        for (const int f : facets_.around(u)) {
            const SurfaceSample o = surfaces_.at(piece(facets_.at(f)), facets_.position(v));
            if (!(std::abs(o.distance) <= std::max(surfaces_.slack(), near))) return {};
        }
        return facets_.collapse(u, v);
    }

    std::optional<Change> split(int f, std::size_t k, double share = 0.5) {
        return split_on_surface(facets_, judge_, f, k, share);
    }

    std::optional<Change> star(int f, Vec3 x) {
        const Facet& facet = facets_.at(f);
        if (!surfaces_.project(x, {piece(facet)}, std::max({length(f, 0), length(f, 1), length(f, 2)}))) return {};
        if (!on_surface(x)) return {};
        Vec3 n = surfaces_.at(piece(facet), x).normal, normals(0.0);
        for (const int k : facet.triangle.normal) normals += facets_.normal(k);
        if (glm::dot(n, normals) < 0) n = -n;
        const int vertex = facets_.add_vertex(x);
        return facets_.star(f, vertex, facets_.add_normal(n));
    }

    // Whether the facet's corner opposite to edge k is no farther than `near` from the surface of the facet across that
    // edge.
    bool lies_beyond(int f, std::size_t k, double near) const {
        const Triangle& t = facets_.at(f).triangle;
        const int other = facets_.across(t.vertex[k], t.vertex[(k + 1) % 3]);
        if (other < 0) return false;
        const SurfaceSample o = surfaces_.at(piece(facets_.at(other)), facets_.position(t.vertex[(k + 2) % 3]));
        return std::abs(o.distance) <= std::max(surfaces_.slack(), near);
    }

    double length(int f, std::size_t k) const {
        const Triangle& t = facets_.at(f).triangle;
        return glm::length(facets_.position(t.vertex[k]) - facets_.position(t.vertex[(k + 1) % 3]));
    }

    // The best change that leaves fewer wrong facets; none if there is none.
    std::optional<Change> straighten(int f, std::size_t& splits_left, RepairStatistics& statistics) {
        const double longest = std::max({length(f, 0), length(f, 1), length(f, 2)});
        std::optional<Change> best;
        int best_gain = 0;
        double best_worst = 0;
        std::size_t* best_count = nullptr;
        const auto offer = [&](std::optional<Change> change, std::size_t& count) {
            if (!change) return;
            const Verdict was = before(*change), is = after(*change);
            // A fold may have to be unrolled step by step. A facet without area may not become a fold.
            constexpr double less = 0.999, min_fold = 0.01;
            const bool may_add = limits_.unfold && &count == &statistics.collapses;
            const bool unrolls =
                (is.wrong == was.wrong || may_add) && &count != &statistics.splits && is.inverted < less * was.inverted;
            if (is.wrong >= was.wrong && !unrolls) return;
            if (is.inverted > was.inverted + min_fold * longest * longest) return;
            if (is.distance > std::max(limits_.farther * was.distance, limits_.of_longest * longest)) return;
            const int gain = was.wrong - is.wrong;
            if (best && (gain < best_gain || (gain == best_gain && is.worst <= best_worst))) return;
            if (!limits_.unfold && is_farther(*change)) return;
            best = std::move(change);
            best_gain = gain;
            best_worst = is.worst;
            best_count = &count;
        };
        for (std::size_t k = 0; k < 3; ++k) {
            offer(facets_.flip(f, k, lies_beyond(f, k, limits_.near * longest)), statistics.flips);
            const Triangle& t = facets_.at(f).triangle;
            const int u = t.vertex[k], v = t.vertex[(k + 1) % 3];
            if (!made(u)) offer(collapse(u, v, limits_.near * longest), statistics.collapses);
            if (!made(v)) offer(collapse(v, u, limits_.near * longest), statistics.collapses);
        }
        if (!best && splits_left > 0)
            for (std::size_t k = 0; k < 3; ++k)
                for (const double share : {0.5, 0.25, 0.75, 0.1, 0.9})
                    if (length(f, k) > shortest()) offer(split(f, k, share), statistics.splits);
        if (best) ++*best_count;
        if (best && best_count == &statistics.splits) --splits_left;
        return best;
    }

    // Puts a vertex where the facet is farthest from its surface: at the middle of an edge, or of the facet.
    std::optional<Change> refine(int f, RepairStatistics& statistics) {
        std::optional<Change> best;
        double most = min_sag();
        const auto offer = [&](std::optional<Change> change, Vec3 from) {
            if (!change) return;
            for (const Facet& g : change->in)
                if (shape(g).own < limits_.better) return;
            const double sag = glm::length(facets_.position(facets_.vertices() - 1) - from);
            if (sag <= most) return;
            most = sag;
            best = std::move(change);
        };
        Vec3 middle(0.0);
        for (std::size_t k = 0; k < 3; ++k) {
            const Triangle& t = facets_.at(f).triangle;
            const Vec3 a = facets_.position(t.vertex[k]), b = facets_.position(t.vertex[(k + 1) % 3]);
            middle += a / 3.0;
            if (length(f, k) > shortest()) offer(split(f, k), 0.5 * (a + b));
        }
        if (facets_.at(f).origin.leaf >= 0) offer(star(f, middle), middle);
        statistics.splits += best.has_value();
        return best;
    }

    bool is_near(const Facet& f) const {
        const auto& v = f.triangle.vertex;
        return judge_.is_near({facets_.position(v[0]), facets_.position(v[1]), facets_.position(v[2])}, tolerance_);
    }

    // Whether the change brings facets beyond the tolerance where no facet was.
    bool is_farther(const Change& change) const {
        return std::isfinite(tolerance_) &&
               !std::all_of(change.in.begin(), change.in.end(), [&](const Facet& f) { return is_near(f); }) &&
               std::all_of(change.out.begin(), change.out.end(), [&](int f) { return is_near(facets_.at(f)); });
    }

    void limit(const Limits& limits) { limits_ = limits; }
    void forbid_splits() { splits_left_ = 0; }

    void mend_facets(RepairStatistics& statistics) {
        std::deque<int> todo;
        for (std::size_t f = 0; f < facets_.size(); ++f)
            if (wrong(int(f))) todo.push_back(int(f));
        if (!splits_left_) splits_left_ = std::min(max_splits + more_splits * todo.size(), splits_at_all);
        std::size_t& splits_left = *splits_left_;
        std::size_t tries_left = max_tries * todo.size();
        std::unordered_set<int> waiting(todo.begin(), todo.end());
        // Facets that nothing helped are tried again after others have changed.
        std::vector<int> stuck;
        constexpr int max_rounds = 6;
        bool changed = true;
        for (int round = 0; round < max_rounds && changed; ++round) {
            changed = false;
            while (!todo.empty() && tries_left > 0) {
                --tries_left;
                const int f = todo.front();
                todo.pop_front();
                waiting.erase(f);
                if (!facets_.alive(f) || !wrong(f)) continue;
                auto change = straighten(f, splits_left, statistics);
                if (!change && splits_left > 0 && shape(f).own >= limits_.leaning) {
                    change = refine(f, statistics);
                    if (change) --splits_left;
                }
                if (!change) {
                    stuck.push_back(f);
                    continue;
                }
                changed = true;
                for (const int g : apply(*change))
                    if (wrong(g) && waiting.insert(g).second) todo.push_back(g);
            }
            for (const int f : stuck)
                if (waiting.insert(f).second) todo.push_back(f);
            stuck.clear();
        }
    }

    bool on_surface(Vec3 x) const { return judge_.on_surface(x); }

    // Turns the normals at a moved vertex to the gradients there.
    void turn_normals(int v) {
        for (const int f : facets_.around(v)) {
            const Facet& facet = facets_.at(f);
            if (facet.origin.leaf < 0) continue;
            const int k = facet.triangle.normal[facets_.corner_index(f, v)];
            const Vec3 old = facets_.normal(k), n = surfaces_.at(piece(facet), facets_.position(v)).normal;
            if (n != Vec3(0.0)) facets_.set_normal(k, glm::dot(n, old) < 0 ? -n : n);
        }
    }

    // Moves x onto the solid's surface. Where surfaces are nearer to each other than chords are to them, any of them
    // will do.
    bool onto_solid(Vec3& x, double reach) const {
        const Vec3 start = x;
        constexpr int steps = 30;
        for (int k = 0; k < steps; ++k) {
            const SurfaceSample o = solid_.at(x);
            if (!std::isfinite(o.distance)) return false;
            x += o.normal * o.distance;
            if (!(glm::length(x - start) <= reach)) return false;
            if (std::abs(o.distance) <= 1e-4 * surfaces_.slack()) return on_surface(x);
        }
        return on_surface(x);
    }

    // Whether all facets around the vertex were found good or are walls.
    bool is_well_known(int v) const {
        return std::ranges::all_of(facets_.around(v),
                                   [&](int f) { return facets_.at(f).origin.leaf == Origin::wall || is_good(f); });
    }
    bool is_good(int f) const { return std::size_t(f) < good_.size() && good_[f] && !changed_[f]; }

    // Moves vertices that are off the surface to where the surfaces around them meet. To be called before any facet is
    // judged.
    void mend_vertices(RepairStatistics& statistics) {
        const auto vertices = std::size_t(facets_.vertices());
        beside_.assign(vertices, false);
        std::vector<char> is_on(vertices);
        judge_in_parallel(judge_, vertices, [&](const FacetJudge& judge, std::size_t first, std::size_t last) {
            for (std::size_t v = first; v < last; ++v)
                is_on[v] = is_well_known(int(v)) || judge.on_surface(facets_.position(int(v)));
        });
        for (int v = 0; v < facets_.vertices(); ++v) {
            if (is_on[v]) continue;
            std::vector<LeafSurface> pieces;
            double shortest = infinity;
            for (const int f : facets_.around(v)) {
                add_surface(pieces, piece(facets_.at(f)));
                for (std::size_t k = 0; k < 3; ++k)
                    if (facets_.at(f).triangle.vertex[k] != v)
                        shortest = std::min(shortest, glm::length(facets_.position(v) -
                                                                  facets_.position(facets_.at(f).triangle.vertex[k])));
            }
            Vec3 x = facets_.position(v);
            const bool on_seam = surfaces_.project(x, pieces, shortest) && on_surface(x);
            if (!on_seam) {
                x = facets_.position(v);
                if (!onto_solid(x, shortest)) {
                    beside_[v] = !(std::abs(solid_.at(facets_.position(v)).distance) <= nearly_on_surface());
                    continue;
                }
            }
            facets_.move(v, x);
            for (const int f : facets_.around(v)) changed_[f] = true;
            turn_normals(v);
            ++statistics.moves;
        }
    }

    void find_good(const GoodFacets& good, const Mesh& mesh) {
        good_.resize(facets_.size());
        in_parallel_ranges(facets_.size(), 4096, [&](std::size_t first, std::size_t last) {
            for (std::size_t f = first; f < last; ++f)
                good_[f] = good.has(mesh, facets_.at(int(f)).triangle, facets_.at(int(f)).origin);
        });
    }

    // Computes the shapes of all facets that are not good; no facet may have changed except by its vertices.
    void judge_all() {
        judge_in_parallel(judge_, facets_.size(), [&](const FacetJudge& judge, std::size_t first, std::size_t last) {
            for (std::size_t f = first; f < last; ++f)
                if (!is_good(int(f))) shapes_[f] = judge.shape(facets_, facets_.at(int(f)));
        });
    }

    // Drops unused vertices and lists what is still wrong.
    void finish(RepairStatistics& statistics) {
        int t = 0;
        statistics.numbers.assign(given_, -1);
        for (std::size_t f = 0; f < facets_.size(); ++f) {
            if (!facets_.alive(int(f))) continue;
            if (f < given_ && !changed_[f]) statistics.numbers[f] = t;
            const auto& v = facets_.at(int(f)).triangle.vertex;
            if (is_beside(v[0]) || is_beside(v[1]) || is_beside(v[2]) || wrong(int(f))) statistics.left.push_back(t);
            if (changed_[f]) statistics.changed.push_back(t);
            if (!is_good(int(f))) statistics.farthest = std::max(statistics.farthest, shape(int(f)).distance);
            ++t;
        }
        facets_.finish();
    }

private:
    std::vector<int> apply(const Change& change) {
        std::vector<int> fresh = facets_.apply(change);
        shapes_.resize(facets_.size());
        changed_.resize(facets_.size());
        for (const int f : fresh) {
            shapes_[f].reset();
            changed_[f] = true;
        }
        return fresh;
    }
    // Vertices that were added are on the surface.
    bool is_beside(int v) const { return std::size_t(v) < beside_.size() && beside_[v]; }

    double nearly_on_surface() const { return std::min(1e-7 * judge_.size(), 5e-7); }
    double shortest() const { return 1e-5 * judge_.size(); }
    double min_sag() const { return 1e-7 * judge_.size(); }
    // Vertices that were added are not collapsed, or the mesh would become what it was before.
    bool made(int vertex) const { return vertex >= first_made_; }

    static int corner_index(const Facet& f, int vertex) {
        const auto& v = f.triangle.vertex;
        return v[0] == vertex ? 0 : v[1] == vertex ? 1 : 2;
    }

    Facets facets_;
    const FacetJudge& judge_;
    double tolerance_;
    const DistanceField& solid_;
    const LeafSurfaces& surfaces_;
    std::vector<std::optional<FacetShape>> shapes_;  // where known
    std::vector<char> good_;                         // facets that were given as good; empty: none
    std::vector<char> changed_;                      // facets that are new or have a vertex that moved
    std::size_t given_;                              // number of facets at the start
    std::vector<char> beside_;                       // vertices that nothing brought onto the surface
    /// Vertices from this number on were added.
    int first_made_;
    Limits limits_ = gentle;
    std::optional<std::size_t> splits_left_;
};

}  // namespace

RepairStatistics repair(Mesh& mesh, std::vector<Origin>& origins, const FacetJudge& judge, double tolerance,
                        bool may_split, const GoodFacets* good, Patches* patches) {
    RepairStatistics statistics;
    if (mesh.triangles.empty()) return statistics;
    Repair work(mesh, origins, judge, tolerance, patches);
    if (good) work.find_good(*good, mesh);
    if (!may_split) work.forbid_splits();
    work.mend_vertices(statistics);
    work.judge_all();
    for (const Limits& limits : {gentle, last_resort}) {
        work.limit(limits);
        work.mend_facets(statistics);
    }
    work.finish(statistics);
    return statistics;
}

}  // namespace deburr
