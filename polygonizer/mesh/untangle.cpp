#include "polygonizer/mesh/untangle.hpp"

#include <algorithm>
#include <optional>

#include "bounds/sort_once.hpp"
#include "polygonizer/mesh/crossing_triangles.hpp"

namespace deburr {
namespace {

// A facet leans if the cosine between it and the surface is below this, as after repair's last resort.
constexpr double upright_when_untangled = 0.05;

/// One round of changes.
class Untangling {
public:
    Untangling(MendedMesh& m, const FacetJudge& judge, double reach)
        : mesh_(m.mesh),
          tree_(m.mesh),
          slack_(touching_slack(tree_.box())),
          facets_(m.mesh, m.origins),
          judge_(judge),
          reach_(reach) {
        std::vector<int> wrong = m.wrong;
        sort_once(wrong);
        for (const int f : wrong)
            if (facets_.alive(f)) help(f);
        facets_.finish();
    }

    std::size_t changes() const { return changes_; }

private:
    // Makes the best change of the facet's edges, if there is one. Facets near one that changed wait for the next
    // round.
    void help(int f) {
        std::optional<Change> best;
        int best_gain = 0;
        const auto offer = [&](std::optional<Change> change) {
            if (!change || !untouched(*change)) return;
            const std::optional<int> after = faults_after(*change);
            if (!after) return;
            // As many faults among fewer facets are a step forward, too.
            const int fewer = int(change->out.size()) - int(change->in.size());
            const int gain = 4 * (faults_before(*change) - *after) + fewer;
            if (gain <= best_gain) return;
            best_gain = gain;
            best = std::move(change);
        };
        const auto offer_edges = [&](int g) {
            const Triangle t = facets_.at(g).triangle;
            for (std::size_t k = 0; k < 3; ++k) {
                offer(facets_.collapse(t.vertex[k], t.vertex[(k + 1) % 3]));
                offer(facets_.collapse(t.vertex[(k + 1) % 3], t.vertex[k]));
                offer(facets_.flip(g, k, true));
            }
        };
        offer_edges(f);
        if (!best)  // else of the facets around it
            for (const int v : facets_.at(f).triangle.vertex)
                for (const int g : facets_.around(v)) offer_edges(g);
        if (!best) return;
        touched_.push_back(box_of(*best));
        facets_.apply(*best);
        ++changes_;
    }

    Box box_of(const Change& change) const {
        Box box;
        for (const int f : change.out) box = hull(box, bounding_box(mesh_, facets_.at(f).triangle));
        for (const Facet& f : change.in) box = hull(box, bounding_box(mesh_, f.triangle));
        return box;
    }
    bool untouched(const Change& change) const {
        const Box box = box_of(change);
        return std::none_of(touched_.begin(), touched_.end(),
                            [&](const Box& other) { return !intersection(box, other).empty(); });
    }

    // The number of the mesh's facets that cross t, without those in `out`.
    int crossings(const Triangle& t, const std::vector<int>& out) const {
        int count = 0;
        tree_.visit(bounding_box(mesh_, t), [&](int other) {
            if (std::find(out.begin(), out.end(), other) == out.end())
                count += crosses(t, mesh_.triangles[std::size_t(other)]);
            return true;
        });
        return count;
    }
    bool crosses(const Triangle& s, const Triangle& t) const { return triangles_cross(mesh_, s, t, slack_); }
    template <class Facet, class TriangleOf>
    int crossings_among(const std::vector<Facet>& facets, TriangleOf triangle) const {
        int count = 0;
        for (std::size_t i = 0; i < facets.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) count += crosses(triangle(facets[i]), triangle(facets[j]));
        return count;
    }
    int faults_before(const Change& change) const {
        const auto triangle = [&](int f) { return facets_.at(f).triangle; };
        int count = crossings_among(change.out, triangle);
        for (const int f : change.out)
            count += crossings(triangle(f), change.out) +
                     (judge_.shape(facets_, facets_.at(f)).cosine < upright_when_untangled);
        return count;
    }
    // The number of faults after the change; none if a facet would be too far from the surface.
    std::optional<int> faults_after(const Change& change) const {
        int count = 0;
        for (const Facet& f : change.in) {
            const FacetShape shape = judge_.shape(facets_, f);
            if (shape.distance > reach_) return {};
            count += shape.cosine < upright_when_untangled;
        }
        for (const Facet& f : change.in) count += crossings(f.triangle, change.out);
        return count + crossings_among(change.in, [](const Facet& f) { return f.triangle; });
    }

    const Mesh& mesh_;
    const TriangleTree tree_;
    double slack_;
    Facets facets_;
    const FacetJudge& judge_;
    double reach_;
    std::vector<Box> touched_;
    std::size_t changes_ = 0;
};

void find_faults(MendedMesh& m, const FacetJudge& judge, CancelFlag cancel) {
    m.wrong.clear();
    const Facets facets(m.mesh, m.origins);
    for (int f = 0; f < int(facets.size()); ++f)
        if (judge.shape(facets, facets.at(f), upright_when_untangled).cosine < upright_when_untangled)
            m.wrong.push_back(f);
    m.leaning = m.wrong.size();
    m.others = add_crossing(m.mesh, m.wrong, cancel);
    m.crosses = m.others > 0;
}

}  // namespace

std::size_t untangle(MendedMesh& m, const FacetJudge& judge, double reach, CancelFlag cancel) {
    constexpr std::size_t max_faults = 1000;  // a mesh with more is wrong as a whole
    if (m.wrong.size() > max_faults) return 0;
    constexpr int max_rounds = 60, patience = 12;  // rounds in all, and rounds without progress
    std::size_t changes = 0, least = m.leaning + m.others;
    for (int round = 0, last = 0; round < max_rounds && round - last <= patience && !m.wrong.empty(); ++round) {
        const std::size_t made = Untangling(m, judge, reach).changes();
        if (made == 0) break;
        changes += made;
        find_faults(m, judge, cancel);
        if (m.leaning + m.others >= least) continue;
        least = m.leaning + m.others;
        last = round;
    }
    return changes;
}

}  // namespace deburr
