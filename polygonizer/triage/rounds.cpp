#include "polygonizer/triage/rounds.hpp"

#include <algorithm>
#include <utility>

#include "bounds/sort_once.hpp"
#include "polygonizer/mesh/refine.hpp"
#include "polygonizer/mesh/repair.hpp"
#include "polygonizer/triage/surface.hpp"

namespace deburr {
namespace {

constexpr std::size_t max_local_rounds = 5;

// The plane through the middle of the cell's box, across its longest side.
Plane middle_plane(const CellComplex& complex, int cell) {
    Box box;
    for (const int v : complex.vertices_of(cell)) box = hull(box, Box{complex.vertices[v], complex.vertices[v]});
    const Vec3 size = box.hi - box.lo;
    const int axis = greatest_axis(size);
    Plane plane{Vec3(0.0), 0.5 * (box.lo[axis] + box.hi[axis])};
    plane.normal[axis] = 1;
    return plane;
}

// Makes the cuts; with `or_middle` a cell that its cut misses is cut through its middle. Returns the cells on both
// sides of the cuts that could be made.
std::vector<int> halve(Subdivision& subdivision, const std::vector<Cut>& cuts, bool or_middle = false) {
    std::vector<int> halves;
    for (const Cut& cut : cuts)
        if (subdivision.halve(cut.cell, cut.plane) ||
            (or_middle && subdivision.halve(cut.cell, middle_plane(subdivision.complex, cut.cell))))
            halves.insert(halves.end(), {cut.cell, int(subdivision.complex.cells.size()) - 1});
    return halves;
}

bool is_near(const Mesh& mesh, int t, const FacetJudge& judge, double tolerance) {
    return judge.is_near(mesh.corners(mesh.triangles[t]), tolerance);
}

}  // namespace

std::vector<int> halve_all(Subdivision& subdivision, const std::vector<Cut>& cuts, bool by_planes) {
    std::vector<int> halves = halve(subdivision, cuts, true);
    if (!by_planes) return halves;
    const int halved = int(subdivision.complex.cells.size());
    const std::size_t count = halves.size();
    for (std::size_t k = 0; k < count; ++k) subdivision.subdivide(halves[k]);
    for (int c = halved; c < int(subdivision.complex.cells.size()); ++c) halves.push_back(c);
    return halves;
}

std::size_t add_far(const Mesh& mesh, const FacetJudge& judge, double tolerance, std::vector<int>& triangles) {
    // Each edge is judged in the triangle in which it runs to the greater vertex, for both of its triangles.
    std::vector<char> far(mesh.triangles.size()), far_edges(mesh.triangles.size());
    judge_in_parallel(judge, far.size(), [&](const FacetJudge& own, std::size_t first, std::size_t last) {
        for (std::size_t t = first; t < last; ++t) {
            const auto& v = mesh.triangles[t].vertex;
            far[t] = !own.is_near_inside(mesh.corners(mesh.triangles[t]), tolerance);
            for (std::size_t k = 0; k < 3; ++k) {
                const int a = v[k], b = v[(k + 1) % 3];
                if (a < b && !own.is_near_between(mesh.positions[a], mesh.positions[b], tolerance))
                    far_edges[t] |= char(1 << k);
            }
        }
    });
    std::vector<std::pair<int, int>> edges;
    for (std::size_t t = 0; t < far.size(); ++t)
        for (std::size_t k = 0; far_edges[t] && k < 3; ++k)
            if (far_edges[t] >> k & 1)
                edges.push_back({mesh.triangles[t].vertex[k], mesh.triangles[t].vertex[(k + 1) % 3]});
    std::sort(edges.begin(), edges.end());
    const std::size_t before = triangles.size();
    for (std::size_t t = 0; t < far.size(); ++t) {
        const auto& v = mesh.triangles[t].vertex;
        for (std::size_t k = 0; !edges.empty() && !far[t] && k < 3; ++k)
            far[t] =
                std::binary_search(edges.begin(), edges.end(), std::pair<int, int>(std::minmax(v[k], v[(k + 1) % 3])));
        if (far[t]) triangles.push_back(int(t));
    }
    return triangles.size() - before;
}

std::vector<int> wrong_before_decimation(Mesh& mesh, std::vector<Origin>& origins, const FacetJudge& judge,
                                         double tolerance, const std::vector<int>& left, CancelFlag cancel,
                                         const GoodFacets* good, Patches* patches) {
    RepairStatistics repaired = repair(mesh, origins, judge, at_points * tolerance, true, good, patches);
    // The other triangles are near, because refine() tested them.
    std::vector<int> far = repaired.changed;
    for (const int t : left)
        if (repaired.numbers[t] >= 0) far.push_back(repaired.numbers[t]);
    std::erase_if(far, [&](int t) { return origins[t].leaf == Origin::wall || is_near(mesh, t, judge, tolerance); });
    if (repaired.left.empty()) return refine(mesh, origins, far, judge, at_points * tolerance, cancel, patches);
    repaired.left.insert(repaired.left.end(), far.begin(), far.end());
    sort_once(repaired.left);
    return repaired.left;
}

std::vector<Cut> without_neighbours(std::vector<Cut> cuts, const std::vector<Cut>& others, const CellComplex& complex) {
    std::vector<int> cells;
    for (const Cut& other : others) cells.push_back(other.cell);
    cells = complex.with_neighbours(cells);
    std::erase_if(cuts, [&](const Cut& cut) { return std::binary_search(cells.begin(), cells.end(), cut.cell); });
    return cuts;
}

// The mesh of some cells.
struct LocalRounds::Part {
    Mesh mesh;
    std::vector<Origin> origins;

    // Returns those of `triangles` that touch no wall, and so are as in the mesh of the whole solid.
    std::vector<int> asked(const std::vector<int>& triangles) const {
        std::vector<char> on_wall(mesh.positions.size(), false);
        for (std::size_t t = 0; t < origins.size(); ++t)
            if (origins[t].leaf == Origin::wall)
                for (const int v : mesh.triangles[t].vertex) on_wall[v] = true;
        std::vector<int> free;
        std::ranges::copy_if(triangles, std::back_inserter(free), [&](int t) {
            return std::ranges::none_of(mesh.triangles[t].vertex, [&](int v) { return bool(on_wall[v]); });
        });
        return free;
    }
};

std::vector<Cut> LocalRounds::hopeful(std::vector<Cut> cuts, const std::vector<char>& given_up) {
    std::erase_if(cuts, [&](const Cut& cut) { return std::size_t(cut.cell) < given_up.size() && given_up[cut.cell]; });
    return cuts;
}

void LocalRounds::give_up(std::vector<char>& given_up, const std::vector<int>& cells) const {
    given_up.resize(subdivision_.complex.cells.size(), false);
    for (const int c : subdivision_.complex.with_neighbours(cells)) given_up[c] = true;
}

LocalRounds::Part LocalRounds::part_around(const std::vector<int>& cells) const {
    throw_if_cancelled(cancel_);
    Part part;
    Subspace subspace(subdivision_, subdivision_.complex.with_neighbours(cells), slack_);
    subspace.polygonize();
    part.mesh = surface(subspace, solid_, &part.origins);
    return part;
}

// Makes the cuts, and halves the resulting cells where they are farther from the surface than splits of edges could
// mend: sheets of the surface are close together there.
std::vector<int> LocalRounds::halve_coarse(const std::vector<Cut>& cuts, double tolerance) const {
    // In tolerances; nearer triangles are left to splits of edges.
    constexpr double coarse = 5;
    constexpr std::size_t max_rounds = 24;
    std::vector<int> halves = halve(subdivision_, cuts), all = halves;
    for (std::size_t k = 0; k < max_rounds && !halves.empty() && may_halve(); ++k) {
        throw_if_cancelled(cancel_);
        Subspace part(subdivision_, subdivision_.complex.with_neighbours(halves), slack_);
        part.polygonize();
        halves = halve(subdivision_, cells_to_halve(part, coarse * tolerance));
        all.insert(all.end(), halves.begin(), halves.end());
    }
    return all;
}

std::size_t LocalRounds::cut_leaning(const std::vector<Cut>& cuts, std::size_t most) const {
    std::vector<int> halves = halve(subdivision_, cuts);
    std::size_t times = !halves.empty();
    while (!halves.empty() && times < most && may_halve()) {
        const Part part = part_around(halves);
        halves = halve(subdivision_, cells_to_halve(part.mesh, part.origins, subdivision_));
        times += !halves.empty();
    }
    return times;
}

bool LocalRounds::cut_far(const std::vector<Cut>& cuts, const FacetJudge& judge, double near, std::size_t left,
                          double tolerance) {
    std::vector<int> halves = halve_coarse(cuts, near);
    const bool any = !halves.empty();
    for (std::size_t k = 0; k < max_local_rounds && !halves.empty() && may_halve(); ++k) {
        Part part = part_around(halves);
        const std::vector<int> all_far = refine(part.mesh, part.origins, judge, near, cancel_, good_),
                               far = part.asked(all_far);
        std::vector<Cut> next;
        if (2 * far.size() < std::exchange(left, far.size()))
            next = cells_to_halve(part.mesh, part.origins, far, subdivision_);
        else if (!far.empty())
            give_up(far_given_up_, halves);
        if (std::isfinite(tolerance)) {
            const std::vector<int> wrong =
                part.asked(wrong_before_decimation(part.mesh, part.origins, judge, tolerance, all_far, cancel_, good_));
            mend(without_neighbours(cells_around(part.mesh, part.origins, wrong, subdivision_), next,
                                    subdivision_.complex),
                 judge, tolerance, wrong.size());
        }
        halves = halve_coarse(next, near);
    }
    return any;
}

bool LocalRounds::mend(std::vector<Cut> cuts, const FacetJudge& judge, double tolerance, std::size_t wrong) {
    bool any = false;
    for (std::size_t k = 0; k < max_local_rounds && may_halve(); ++k) {
        const std::vector<int> halves = halve_all(subdivision_, cuts);
        if (halves.empty()) break;
        any = true;
        Part part = part_around(halves);
        const std::vector<int> left = refine(part.mesh, part.origins, judge, at_points * tolerance, cancel_, good_);
        const std::vector<int> found =
            part.asked(wrong_before_decimation(part.mesh, part.origins, judge, tolerance, left, cancel_, good_));
        if (found.empty()) break;
        if (found.size() >= wrong) {
            give_up(wrong_given_up_, halves);
            break;
        }
        wrong = found.size();
        cuts = cells_around(part.mesh, part.origins, found, subdivision_);
    }
    return any;
}

}  // namespace deburr
