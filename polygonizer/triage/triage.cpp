#include "polygonizer/triage/triage.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "bounds/bounding_box.hpp"
#include "bounds/sort_once.hpp"
#include "polygonizer/mesh/crossing_triangles.hpp"
#include "polygonizer/mesh/decimate.hpp"
#include "polygonizer/mesh/degenerate_shells.hpp"
#include "polygonizer/mesh/refine.hpp"
#include "polygonizer/mesh/repair.hpp"
#include "polygonizer/mesh/separate_touching.hpp"
#include "polygonizer/mesh/sharp_parts.hpp"
#include "polygonizer/mesh/simplify_borders.hpp"
#include "polygonizer/triage/rounds.hpp"
#include "polygonizer/triage/surface.hpp"

namespace deburr {

Box polygonization_box(const SolidTree& solid) {
    Box box = bounding_box(solid);
    if (box.empty()) return box;
    double size = 0;
    for (int k = 0; k < 3; ++k)
        if (std::isfinite(box.hi[k] - box.lo[k])) size = std::max(size, box.hi[k] - box.lo[k]);
    if (size == 0) size = 1;
    // A side that is infinite ends this many sizes away from what is finite.
    constexpr double reach = 10;
    for (int k = 0; k < 3; ++k) {
        const bool lo = std::isfinite(box.lo[k]), hi = std::isfinite(box.hi[k]);
        if (!lo && !hi)
            box.lo[k] = -reach * size, box.hi[k] = reach * size;
        else if (!lo)
            box.lo[k] = box.hi[k] - reach * size;
        else if (!hi)
            box.hi[k] = box.lo[k] + reach * size;
        else {
            box.lo[k] -= 0.05 * size;
            box.hi[k] += 0.05 * size;
        }
    }
    return box;
}

namespace {

// Of a tolerance, what is polygonized in cells that thinning out would make flat again.
constexpr double of_slack = 0.4;

// Instead of `at_points` for a mesh that is to be looked at, whose normals have to be right between its vertices.
constexpr double at_points_of_picture = 0.2;

// Adds boxes around the triangle's corners, as large as its shortest edge.
void add_corners(const Mesh& mesh, const Triangle& triangle, std::vector<Box>& boxes) {
    Vec3 x[3];
    for (std::size_t k = 0; k < 3; ++k) x[k] = mesh.positions[triangle.vertex[k]];
    const double shortest = std::min({glm::length(x[0] - x[1]), glm::length(x[1] - x[2]), glm::length(x[2] - x[0])});
    for (const Vec3& corner : x) boxes.push_back(inflated(Box{corner, corner}, 0.5 * shortest));
}

}  // namespace

Mesh triage(const SolidTree& mixed, const Box& box, const TriageOptions& options, TriageStatistics* statistics) {
    if (box.empty()) return {};
    const SolidTree solid = separate_sharp(mixed);
    const bool thin_out = options.decimate && std::isfinite(options.tolerance);
    // Shares of what is left, as they are with most models.
    const auto begin = [&](double share) {
        if (options.progress) options.progress->begin(share);
    };
    const double slack = thin_out ? of_slack * options.tolerance : 0;
    begin(0.25);
    Subdivision subdivision(solid, box, {options.max_half_spaces, options.cancel, options.progress});
    Mesh mesh, best;
    std::vector<Origin> origins, best_origins;
    constexpr std::size_t most = std::numeric_limits<std::size_t>::max();
    constexpr std::pair<std::size_t, std::size_t> none{0, 0};
    std::pair<std::size_t, std::size_t> min_wrong{most, most};
    double farthest = 0;
    std::optional<FacetJudge> judge;
    // Each round halves the cells that need it.
    const std::size_t max_rounds = std::isfinite(options.tolerance) ? 6 : 5;
    constexpr std::size_t max_mending_rounds = 8, max_fine_rounds = 6;
    std::size_t rounds = 0, whole_rounds = 0, mending = 0;
    std::vector<int> best_left;  // triangles of it that are wrong
    std::vector<Box> dense;      // where a mesh that was thinned out was wrong
    // Where surfaces nearly touch, halves of what is too far may be too far for ever.
    LocalRounds local(subdivision, solid, slack, 8 * subdivision.complex.cells.size() + 20'000, options.cancel);
    GoodFacets good;  // of the last round's mesh
    while (mending < max_mending_rounds) {
        throw_if_cancelled(options.cancel);
        begin(0.15);
        Subspace subspace(subdivision, slack);
        subspace.polygonize();
        origins.clear();
        mesh = surface(subspace, solid, &origins);
        ++whole_rounds;
        ++rounds;
        const bool may_cut = rounds < max_rounds && local.may_halve();
        if (may_cut && !std::isfinite(options.tolerance))
            if (const std::size_t times =
                    local.cut_leaning(cells_to_halve(mesh, origins, subdivision), max_rounds - rounds)) {
                rounds += times - 1;
                continue;
            }
        if (!judge) judge.emplace(solid, mesh);
        drop_flat_shells(mesh, origins, 10 * subdivision.complex.tolerance, judge->solid());
        std::vector<int> left;
        std::vector<Cut> far, around_wrong;
        const double near = (options.decimate ? at_points : at_points_of_picture) * options.tolerance;
        if (std::isfinite(options.tolerance)) {
            begin(0.2);
            left = refine(mesh, origins, *judge, near, options.cancel, &good);
            // What halves do not help is looked at again when all is done, by the tolerance itself.
            if (may_cut) far = local.hopeful_far(cells_to_halve(mesh, origins, left, subdivision));
        }
        std::vector<int> wrong;
        if (thin_out) {
            // Facets that lean are mended first, while there are small ones to do it with. Smaller cells for those that
            // cannot be mended cost less before the rest is thinned out, as long as they help.
            wrong = wrong_before_decimation(mesh, origins, *judge, options.tolerance, left, options.cancel, &good);
            if (mending < max_fine_rounds && local.may_halve())
                around_wrong = without_neighbours(local.hopeful_wrong(cells_around(mesh, origins, wrong, subdivision)),
                                                  far, subdivision.complex);
        }
        const bool cut =
            !far.empty() && local.cut_far(far, *judge, near, left.size(), thin_out ? options.tolerance : infinity);
        const bool mended_some =
            !around_wrong.empty() && local.mend(std::move(around_wrong), *judge, options.tolerance, wrong.size());
        mending += mended_some;
        if (cut || mended_some) {
            good.become(mesh, origins, thin_out ? wrong : left);
            local.know(good);
            continue;
        }
        if (thin_out) {
            begin(0.8);
            decimate(mesh, origins, *judge, at_points * options.tolerance,
                     {.dense = dense, .cancel = options.cancel, .progress = options.progress});
        }
        // What repair cannot help needs smaller cells around it.
        begin(0.3);
        ++mending;
        std::vector<Cut> cuts[2];
        bool crosses = false;
        for (const bool may_split : {true, false}) {
            Mesh mended = mesh;
            std::vector<Origin> mended_origins = origins;
            RepairStatistics repaired = repair(mended, mended_origins, *judge, options.tolerance, may_split);
            drop_wrong_shells(mended, mended_origins, repaired.left);
            // Facets that lean or face inward are the graver fault.
            std::pair<std::size_t, std::size_t> faults{repaired.left.size(), 0};
            faults.second += add_crossing(mended, repaired.left, options.cancel);
            crosses |= faults.second > 0;
            if (std::isfinite(options.tolerance))
                faults.second += add_far(mended, *judge, options.tolerance, repaired.left);
            sort_once(repaired.left);
            cuts[may_split] = cells_around(mended, mended_origins, repaired.left, subdivision);
            if (faults < min_wrong) {
                min_wrong = faults;
                farthest = repaired.farthest;
                best = std::move(mended);
                best_left = repaired.left;
                best_origins = std::move(mended_origins);
            }
            if (min_wrong == none) break;
        }
        if (min_wrong == none || !local.may_halve()) break;
        if (halve_all(subdivision, cuts[0], crosses).empty() && halve_all(subdivision, cuts[1], crosses).empty() &&
            !thin_out)
            break;
        for (const int t : best_left) add_corners(best, best.triangles[t], dense);
    }
    mesh = std::move(best);
    origins = std::move(best_origins);
    simplify_borders(mesh, origins, *judge, farthest);
    merge_close(mesh);
    if (statistics) {
        statistics->cells = subdivision.complex.cells.size();
        statistics->rounds = whole_rounds;
        statistics->open_cells = 0;
        for (const int node : subdivision.node_of)
            statistics->open_cells += subdivision.nodes[node].side == Side::straddling;
    }
    return mesh;
}

}  // namespace deburr
