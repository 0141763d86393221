#include "polygonizer/octree/octree_mending.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "polygonizer/mesh/crossing_triangles.hpp"
#include "polygonizer/mesh/decimate.hpp"
#include "polygonizer/mesh/repair.hpp"
#include "polygonizer/octree/octree.hpp"
#include "polygonizer/octree/unfold.hpp"

namespace deburr {
namespace {

// The middle of an edge that is not between two triangles of opposite directions, for the message.
std::optional<Vec3> first_fault(const Mesh& mesh) {
    std::vector<std::array<int, 3>> edges;  // lower end, higher end, direction
    for (const Triangle& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [lo, hi] = std::minmax(t.vertex[k], t.vertex[(k + 1) % 3]);
            edges.push_back({lo, hi, t.vertex[k] == lo});
        }
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 0; i < edges.size();) {
        std::size_t end = i, forward = 0;
        while (end < edges.size() && edges[end][0] == edges[i][0] && edges[end][1] == edges[i][1])
            forward += std::size_t(edges[end++][2]);
        if (end - i != 2 || forward != 1) return 0.5 * (mesh.positions[edges[i][0]] + mesh.positions[edges[i][1]]);
        i = end;
    }
    return std::nullopt;
}

}  // namespace

MendedMesh mended(Mesh mesh, std::vector<Origin> origins, const FacetJudge& judge, double tolerance,
                  CancelFlag cancel) {
    MendedMesh m;
    m.mesh = std::move(mesh);
    m.origins = std::move(origins);
    std::vector<std::pair<int, int>> pairs;  // pairs that cross
    constexpr int max_unfoldings = 3;        // an unfolded facet may lie on the next one
    for (int round = 0; round < max_unfoldings; ++round) {
        m.wrong = repair(m.mesh, m.origins, judge, tolerance).left;
        // Where a wall is thinner than the cells, facets on its two sides are upright and cross.
        pairs = crossing_triangles(m.mesh, TriangleTree(m.mesh), cancel);
        if (pairs.empty() || unfold(m.mesh, m.origins, judge, pairs) == 0) break;
    }
    m.leaning = m.wrong.size();
    m.others = pairs.size();
    m.crosses = m.others > 0;
    for (const auto& [s, t] : pairs) m.wrong.insert(m.wrong.end(), {s, t});
    return m;
}

MendedMesh thinned_out(const MendedMesh& fine, const SolidTree& solid, double tolerance, CancelFlag cancel,
                       WorkProgress* progress) {
    constexpr int max_thinnings = 4;
    constexpr double at_points = 0.85;  // relative to the tolerance, at the points that collapses test
    const FacetJudge judge(solid, fine.mesh);
    std::vector<Box> dense;
    for (int round = 0; round < max_thinnings; ++round) {
        Mesh mesh = fine.mesh;
        std::vector<Origin> origins = fine.origins;
        decimate(mesh, origins, judge, at_points * tolerance, {.dense = dense, .cancel = cancel, .progress = progress});
        MendedMesh thin = mended(std::move(mesh), std::move(origins), judge, tolerance, cancel);
        if (!fine.is_better_than(thin)) return thin;
        for (const int t : thin.wrong) dense.push_back(bounding_box(thin.mesh, thin.mesh.triangles[t]));
    }
    return fine;
}

void throw_unless_closed(const Mesh& mesh) {
    const Topology t = topology(mesh);
    if (t.manifold()) return;
    std::string where;
    if (const auto x = first_fault(mesh)) where = fmt::format(", first at ({:.6g}, {:.6g}, {:.6g})", x->x, x->y, x->z);
    throw OpenMeshError(
        fmt::format("the mesh does not close: {} edges in one triangle, {} in more than two, {} turned, {} points of "
                    "several fans{}",
                    t.open_edges, t.nonmanifold_edges, t.flipped_edges, t.nonmanifold_vertices, where));
}

}  // namespace deburr
