#include "polygonizer/triage/triage.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include "bounds/bounding_box.hpp"
#include "polygonizer/mesh/decimate.hpp"
#include "polygonizer/mesh/degenerate_shells.hpp"
#include "polygonizer/mesh/repair.hpp"
#include "polygonizer/mesh/separate_touching.hpp"
#include "polygonizer/mesh/sharp_parts.hpp"
#include "polygonizer/mesh/simplify_borders.hpp"
#include "polygonizer/triage/refinement.hpp"
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

// Of a tolerance, at the middles of triangles and edges: the rest is for what lies between, and for
// distances being of first order.
constexpr double at_middles = 0.85;
// The same at the points of large triangles, between which the surface may bend more.
constexpr double at_points = 0.65;

// Makes the cuts; the cells on both sides of those that could be made.
std::vector<int> halve(Subdivision& subdivision, const std::vector<Cut>& cuts) {
    std::vector<int> halves;
    for (const Cut& cut : cuts)
        if (subdivision.halve(cut.cell, cut.plane))
            halves.insert(halves.end(), {cut.cell, int(subdivision.complex.cells.size()) - 1});
    return halves;
}

}  // namespace

Mesh triage(const SolidTree& mixed, const Box& box, const TriageOptions& options, TriageStatistics* statistics) {
    if (box.empty()) return {};
    const SolidTree solid = separate_sharp(mixed);
    const bool thin_out = options.decimate && std::isfinite(options.tolerance);
    Subdivision subdivision(solid, box);
    Mesh mesh, best;
    std::vector<Origin> origins, best_origins;
    std::size_t least_left = std::numeric_limits<std::size_t>::max();
    double farthest = 0;
    std::optional<FacetJudge> judge;
    // Each round halves the cells that need it. Halving quarters the distance, so a tolerance is met,
    // or cells have become negligible, long before the last.
    const std::size_t most_rounds = std::isfinite(options.tolerance) ? 24 : 5;
    constexpr std::size_t most_mending_rounds = 8;
    std::size_t mending = 0;
    // Where surfaces nearly touch, halves of what is too far may be too far for ever.
    const std::size_t max_cells = 8 * subdivision.complex.cells.size() + 20'000;
    const auto may_halve = [&] { return subdivision.complex.cells.size() < max_cells; };
    for (std::size_t round = 0; mending < most_mending_rounds; ++round) {
        throw_if_stopped(options.stop);
        Subspace subspace(subdivision);
        subspace.polygonize();
        origins.clear();
        mesh = surface(subspace, solid, &origins);
        if (statistics) statistics->rounds = round + 1;
        if (round + 1 < most_rounds && may_halve()) {
            const double tolerance = at_middles * options.tolerance;
            std::vector<int> halves = halve(subdivision, cells_to_halve(mesh, origins, subdivision, tolerance));
            const bool changed = !halves.empty();
            // What has been halved is looked at again without the rest, until it seems to be enough.
            for (std::size_t k = 1; k < most_rounds && std::isfinite(tolerance) && !halves.empty() && may_halve();
                 ++k) {
                throw_if_stopped(options.stop);
                Subspace part(subdivision);
                part.polygonize(with_neighbours(subdivision.complex, halves));
                halves = halve(subdivision, cells_to_halve(part, tolerance));
            }
            if (changed) continue;
        }
        if (!judge) judge.emplace(solid, mesh);
        drop_sheets(mesh, origins, 10 * subdivision.complex.tolerance, judge->solid());
        if (thin_out) decimate(mesh, origins, *judge, at_points * options.tolerance, options.stop);
        // What repair cannot help needs smaller cells around it.
        ++mending;
        std::vector<Cut> cuts[2];
        for (const bool may_split : {true, false}) {
            Mesh mended = mesh;
            std::vector<Origin> mended_origins = origins;
            RepairStatistics repaired = repair(mended, mended_origins, *judge, may_split);
            drop_wrong_sheets(mended, mended_origins, repaired.left);
            cuts[may_split] = cells_around(mended, mended_origins, repaired.left, subdivision);
            if (repaired.left.size() < least_left) {
                least_left = repaired.left.size();
                farthest = repaired.farthest;
                best = std::move(mended);
                best_origins = std::move(mended_origins);
            }
            if (least_left == 0) break;
        }
        if (least_left == 0 || !may_halve() ||
            (halve(subdivision, cuts[0]).empty() && halve(subdivision, cuts[1]).empty()))
            break;
    }
    mesh = std::move(best);
    origins = std::move(best_origins);
    thin_borders(mesh, origins, *judge, farthest);
    merge_close(mesh);
    if (statistics) {
        statistics->cells = subdivision.complex.cells.size();
        statistics->open_cells = 0;
        for (const int place : subdivision.place_of)
            statistics->open_cells += subdivision.places[std::size_t(place)].side == Side::straddling;
    }
    return mesh;
}

}  // namespace deburr
