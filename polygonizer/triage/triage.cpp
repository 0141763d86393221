#include "polygonizer/triage/triage.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "bounds/bounding_box.hpp"
#include "polygonizer/mesh/crossing_triangles.hpp"
#include "polygonizer/mesh/decimate.hpp"
#include "polygonizer/mesh/degenerate_shells.hpp"
#include "polygonizer/mesh/refine.hpp"
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

// Of a tolerance, at the points of a triangle that are looked at: the rest is for what lies between, and for distances
// being of first order.
constexpr double at_points = 0.85;

// The same for a mesh that is to be looked at, whose normals have to be right between its vertices.
constexpr double at_points_of_picture = 0.2;

// Makes the cuts; the cells on both sides of those that could be made.
std::vector<int> halve(Subdivision& subdivision, const std::vector<Cut>& cuts) {
    std::vector<int> halves;
    for (const Cut& cut : cuts)
        if (subdivision.halve(cut.cell, cut.plane))
            halves.insert(halves.end(), {cut.cell, int(subdivision.complex.cells.size()) - 1});
    return halves;
}

// Across the longest side of the cell's box.
Plane middle_plane(const CellComplex& complex, int cell) {
    Box box;
    for (const int v : complex.vertices_of(cell)) box = hull(box, Box{complex.vertices[v], complex.vertices[v]});
    const Vec3 size = box.hi - box.lo;
    const int axis = greatest_axis(size);
    Plane plane{Vec3(0.0), 0.5 * (box.lo[axis] + box.hi[axis])};
    plane.normal[axis] = 1;
    return plane;
}

// Halves every cell, through its middle where the cut passes it by: triangles that were split or flipped reach beyond
// the cell that they came from. Whether any cell was halved.
// `by_planes`: the halves are cut on, as far as planes of their own go. Sheets that lie in one plane, and part along a
// curve, cross again in halves, however small, until the curve is a border of cells.
bool halve_all(Subdivision& subdivision, const std::vector<Cut>& cuts, bool by_planes = false) {
    const int before = int(subdivision.complex.cells.size());
    for (const Cut& cut : cuts)
        if (!subdivision.halve(cut.cell, cut.plane))
            subdivision.halve(cut.cell, middle_plane(subdivision.complex, cut.cell));
    const int halved = int(subdivision.complex.cells.size());
    if (by_planes) {
        for (const Cut& cut : cuts) subdivision.subdivide(cut.cell);
        for (int c = before; c < halved; ++c) subdivision.subdivide(c);
    }
    return int(subdivision.complex.cells.size()) > before;
}

// Halves the cells of these triangles, and what is farther from the surface than splits of edges could mend: there
// sheets lie close together. What has been halved is looked at again without the rest. False if nothing could be cut.
bool cut_cells(Subdivision& subdivision, const Mesh& mesh, const std::vector<Origin>& origins,
               const std::vector<int>& triangles, double tolerance, std::size_t max_cells, CancelFlag cancel) {
    // Of the tolerance; splits of edges begin there.
    constexpr double coarse = 5;
    constexpr std::size_t max_rounds = 24;
    std::vector<int> halves = halve(subdivision, cells_to_halve(mesh, origins, triangles, subdivision));
    const bool changed = !halves.empty();
    for (std::size_t k = 0; k < max_rounds && !halves.empty() && subdivision.complex.cells.size() < max_cells; ++k) {
        throw_if_cancelled(cancel);
        Subspace part(subdivision, subdivision.complex.with_neighbours(halves));
        part.polygonize();
        halves = halve(subdivision, cells_to_halve(part, coarse * tolerance));
    }
    return changed;
}

void sort_once(std::vector<int>& numbers) {
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

bool is_near(const Mesh& mesh, int t, const FacetJudge& judge, double tolerance) {
    std::array<Vec3, 3> x;
    for (std::size_t k = 0; k < 3; ++k) x[k] = mesh.positions[mesh.triangles[t].vertex[k]];
    return judge.is_near(x, tolerance);
}

// Adds triangles that are farther from the surface than the tolerance; returns how many.
std::size_t add_far(const Mesh& mesh, const FacetJudge& judge, double tolerance, std::vector<int>& triangles) {
    std::vector<char> far(mesh.triangles.size());
    judge_in_parallel(judge, far.size(), [&](const FacetJudge& own, std::size_t first, std::size_t last) {
        for (std::size_t t = first; t < last; ++t) far[t] = !is_near(mesh, int(t), own, tolerance);
    });
    const std::size_t before = triangles.size();
    for (std::size_t t = 0; t < far.size(); ++t)
        if (far[t]) triangles.push_back(int(t));
    return triangles.size() - before;
}

// Repairs a mesh that `refine` left with these triangles too far from the surface, and refines what its last
// resort made too coarse. What is wrong with it then, sorted: what is too far now is too far in a mesh that
// is thinned out, too.
std::vector<int> wrong_before_decimation(Mesh& mesh, std::vector<Origin>& origins, const FacetJudge& judge,
                                         double tolerance, const std::vector<int>& left, CancelFlag cancel) {
    const bool all_near = std::ranges::all_of(left, [&](int t) { return is_near(mesh, t, judge, tolerance); });
    RepairStatistics repaired = repair(mesh, origins, judge, at_points * tolerance);
    std::vector<int> far;
    if (all_near)
        std::ranges::copy_if(repaired.changed, std::back_inserter(far),
                             [&](int t) { return !is_near(mesh, t, judge, tolerance); });
    else
        add_far(mesh, judge, tolerance, far);
    if (repaired.left.empty()) return refine(mesh, origins, far, judge, at_points * tolerance, cancel);
    repaired.left.insert(repaired.left.end(), far.begin(), far.end());
    sort_once(repaired.left);
    return repaired.left;
}

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
    std::size_t mending = 0, last_left = most, last_wrong = most;
    std::vector<int> best_left;  // triangles of it that are wrong
    std::vector<Box> dense;      // where a mesh that was thinned out was wrong
    // Where surfaces nearly touch, halves of what is too far may be too far for ever.
    const std::size_t max_cells = 8 * subdivision.complex.cells.size() + 20'000;
    const auto may_halve = [&] { return subdivision.complex.cells.size() < max_cells; };
    for (std::size_t round = 0; mending < max_mending_rounds; ++round) {
        throw_if_cancelled(options.cancel);
        begin(0.15);
        Subspace subspace(subdivision);
        subspace.polygonize();
        origins.clear();
        mesh = surface(subspace, solid, &origins);
        if (statistics) statistics->rounds = round + 1;
        const bool may_cut = round + 1 < max_rounds && may_halve();
        if (may_cut && !std::isfinite(options.tolerance) &&
            !halve(subdivision, cells_to_halve(mesh, origins, subdivision)).empty())
            continue;
        if (!judge) judge.emplace(solid, mesh);
        drop_flat_shells(mesh, origins, 10 * subdivision.complex.tolerance, judge->solid());
        std::vector<int> left;
        if (std::isfinite(options.tolerance)) {
            begin(0.2);
            const double tolerance = (options.decimate ? at_points : at_points_of_picture) * options.tolerance;
            left = refine(mesh, origins, *judge, tolerance, options.cancel);
            // What hardly becomes less is looked at again when all is done, by the tolerance itself.
            const bool helped = 2 * left.size() < std::exchange(last_left, left.size());
            if (may_cut && helped && !left.empty() &&
                cut_cells(subdivision, mesh, origins, left, tolerance, max_cells, options.cancel))
                continue;
        }
        if (thin_out) {
            // Facets that lean are mended first, while there are small ones to do it with. Smaller cells for those that
            // cannot be mended cost less before the rest is thinned out, as long as they help.
            const std::vector<int> wrong =
                wrong_before_decimation(mesh, origins, *judge, options.tolerance, left, options.cancel);
            const bool helped = wrong.size() < std::exchange(last_wrong, wrong.size());
            if (!wrong.empty() && helped && mending < max_fine_rounds && may_halve() &&
                halve_all(subdivision, cells_around(mesh, origins, wrong, subdivision))) {
                ++mending;
                continue;
            }
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
            std::pair<std::size_t, std::size_t> wrong{repaired.left.size(), 0};
            wrong.second += add_crossing(mended, repaired.left, options.cancel);
            crosses |= wrong.second > 0;
            if (std::isfinite(options.tolerance))
                wrong.second += add_far(mended, *judge, options.tolerance, repaired.left);
            sort_once(repaired.left);
            cuts[may_split] = cells_around(mended, mended_origins, repaired.left, subdivision);
            if (wrong < min_wrong) {
                min_wrong = wrong;
                farthest = repaired.farthest;
                best = std::move(mended);
                best_left = repaired.left;
                best_origins = std::move(mended_origins);
            }
            if (min_wrong == none) break;
        }
        if (min_wrong == none || !may_halve()) break;
        if (!halve_all(subdivision, cuts[0], crosses) && !halve_all(subdivision, cuts[1], crosses) && !thin_out) break;
        for (const int t : best_left) add_corners(best, best.triangles[t], dense);
    }
    mesh = std::move(best);
    origins = std::move(best_origins);
    simplify_borders(mesh, origins, *judge, farthest);
    merge_close(mesh);
    if (statistics) {
        statistics->cells = subdivision.complex.cells.size();
        statistics->open_cells = 0;
        for (const int node : subdivision.node_of)
            statistics->open_cells += subdivision.nodes[node].side == Side::straddling;
    }
    return mesh;
}

}  // namespace deburr
