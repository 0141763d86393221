#include "polygonizer/octree/unfold.hpp"

#include <algorithm>
#include <optional>

#include "polygonizer/mesh/split_on_surface.hpp"

namespace deburr {
namespace {

// The least cosine between a new facet and its surface.
constexpr double upright_when_unfolded = 0.2;

// The change that gives facet f, which shares an edge with `other`, to the surface of `other`.
std::optional<Change> given_beyond(const Facets& facets, const FacetJudge& judge, int f, int other) {
    const Triangle& t = facets.at(f).triangle;
    for (std::size_t k = 0; k < 3; ++k) {
        if (facets.across(t.vertex[k], t.vertex[(k + 1) % 3]) != other) continue;
        const LeafSurface beyond = surface_of(facets, facets.at(other));
        const Vec3 tip = facets.position(t.vertex[(k + 2) % 3]);
        if (!(std::abs(judge.surfaces().at(beyond, tip).distance) <= judge.surfaces().slack())) return {};
        auto change = facets.flip(f, k, true);
        if (!change) return {};
        const bool good = std::all_of(change->in.begin(), change->in.end(), [&](const Facet& g) {
            return judge.shape(facets, g).cosine >= upright_when_unfolded;
        });
        return good ? change : std::nullopt;
    }
    return {};
}

}  // namespace

std::size_t unfold(Mesh& mesh, std::vector<Origin>& origins, const FacetJudge& judge,
                   const std::vector<std::pair<int, int>>& pairs) {
    std::size_t count = 0;
    Facets facets(mesh, origins);
    for (const auto& [s, t] : pairs)
        for (const auto& [f, other] : {std::pair{s, t}, std::pair{t, s}}) {
            if (!facets.alive(f) || !facets.alive(other)) break;
            const auto change = given_beyond(facets, judge, f, other);
            if (!change) continue;
            facets.apply(*change);
            ++count;
            break;
        }
    facets.finish();
    return count;
}

}  // namespace deburr
