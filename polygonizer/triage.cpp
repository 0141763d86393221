#include "polygonizer/triage.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include "bounds/bounding_box.hpp"
#include "polygonizer/parallel_family.hpp"
#include "polygonizer/repair.hpp"
#include "polygonizer/separate.hpp"
#include "polygonizer/sharp_parts.hpp"
#include "polygonizer/surface.hpp"
#include "polygonizer/thin_borders.hpp"

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
        if (!lo && !hi) box.lo[k] = -reach * size, box.hi[k] = reach * size;
        else if (!lo) box.lo[k] = box.hi[k] - reach * size;
        else if (!hi) box.hi[k] = box.lo[k] + reach * size;
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

struct Cut {
    int cell;
    double error;  // how much it is needed
    Plane plane;
};

// Of each cell the most needed.
void worst_of_each(std::vector<Cut>& cuts) {
    std::sort(cuts.begin(), cuts.end(), [](const Cut& a, const Cut& b) {
        return a.cell != b.cell ? a.cell < b.cell : a.error > b.error;
    });
    cuts.erase(std::unique(cuts.begin(), cuts.end(), [](const Cut& a, const Cut& b) { return a.cell == b.cell; }),
               cuts.end());
}

// Halves the edge of the triangle along which the surface's normal turns most; along a sweep it
// does not turn.
Plane halving(const Mesh& mesh, const Triangle& t, const LocalDensity& density) {
    double most = -1;
    Plane plane{};
    Vec3 sweep(0.0);
    const bool swept = is_swept(density, sweep);
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t l = (k + 1) % 3;
        const Vec3 a = mesh.positions[std::size_t(t.vertex[k])], b = mesh.positions[std::size_t(t.vertex[l])];
        const double turn = glm::length(mesh.normals[std::size_t(t.normal[k])] - mesh.normals[std::size_t(t.normal[l])]);
        Vec3 along = b - a;
        if (swept) along -= sweep * glm::dot(sweep, along);
        if (turn <= most || glm::length(along) == 0) continue;
        most = turn;
        plane.normal = glm::normalize(along);
        plane.offset = glm::dot(plane.normal, 0.5 * (a + b));
    }
    return plane;
}

// Cells whose part of the mesh leans too far from the surface's normal, or is too far from it.
std::vector<Cut> cells_to_halve(const Mesh& mesh, const std::vector<Origin>& origins,
                                const Subdivision& subdivision, double tolerance) {
    // Cosine between a triangle and the surface below which its cell is halved: 75°.
    constexpr double least_cosine = 0.25;
    // A sliver leans for other reasons, which halving does not help: repair.hpp.
    constexpr double sliver = 0.005;  // height over longest side
    std::vector<Cut> cuts;
    for (std::size_t k = 0; k < origins.size(); ++k) {
        if (origins[k].cell < 0) continue;
        const Triangle& t = mesh.triangles[k];
        const Vec3 area = mesh.area_vector(t);
        Vec3 normal(0.0), centre(0.0);
        double longest2 = 0;
        for (std::size_t j = 0; j < 3; ++j) {
            const Vec3 x = mesh.positions[std::size_t(t.vertex[j])];
            const Vec3 d = x - mesh.positions[std::size_t(t.vertex[(j + 1) % 3])];
            normal += mesh.normals[std::size_t(t.normal[j])];
            centre += x / 3.0;
            longest2 = std::max(longest2, glm::dot(d, d));
        }
        const LocalDensity& density = *subdivision.open(origins[k].cell, origins[k].leaf)->density;
        const ValueGradient here = density.gradient_at(centre);
        const double slope = glm::length(here.gradient), size = glm::length(area);
        const double side = glm::dot(here.gradient, normal) > 0 ? 1 : -1;
        const bool leans = size > sliver * longest2 && side * glm::dot(area, here.gradient) < least_cosine * size * slope;
        double distance = slope > 0 ? std::abs(here.value - 0.5) / slope : 0;
        if (std::isfinite(tolerance))
            for (std::size_t j = 0; j < 3; ++j) {
                const Vec3 x = 0.5 * (mesh.positions[std::size_t(t.vertex[j])] + mesh.positions[std::size_t(t.vertex[(j + 1) % 3])]);
                const ValueGradient middle = density.gradient_at(x);
                const double steep = glm::length(middle.gradient);
                if (steep > 0) distance = std::max(distance, std::abs(middle.value - 0.5) / steep);
            }
        if (!leans && distance <= tolerance) continue;
        cuts.push_back({origins[k].cell, distance, halving(mesh, t, density)});
    }
    worst_of_each(cuts);
    return cuts;
}

// The cells that triangles came from, and those of their neighbours.
std::vector<Cut> cells_around(const Mesh& mesh, const std::vector<Origin>& origins, const std::vector<int>& triangles,
                              const Subdivision& subdivision) {
    std::vector<char> near(mesh.positions.size(), false);
    for (const int t : triangles)
        for (const int v : mesh.triangles[std::size_t(t)].vertex) near[std::size_t(v)] = true;
    std::vector<Cut> cuts;
    for (std::size_t k = 0; k < origins.size(); ++k) {
        if (origins[k].cell < 0) continue;
        const Triangle& t = mesh.triangles[k];
        const auto count = std::count_if(t.vertex.begin(), t.vertex.end(), [&](int v) { return near[std::size_t(v)]; });
        if (count < 2) continue;
        const Plane plane = halving(mesh, t, *subdivision.open(origins[k].cell, origins[k].leaf)->density);
        if (plane.normal != Vec3(0.0)) cuts.push_back({origins[k].cell, glm::length(mesh.area_vector(t)), plane});
    }
    worst_of_each(cuts);
    return cuts;
}

}  // namespace

Mesh triage(const SolidTree& mixed, const Box& box, const TriageOptions& options, TriageStatistics* statistics) {
    if (box.empty()) return {};
    const SolidTree solid = separate_sharp(mixed);
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
    for (std::size_t round = 0; mending < most_mending_rounds; ++round) {
        Subspace subspace(subdivision);
        subspace.polygonize();
        origins.clear();
        mesh = surface(subspace, solid, &origins);
        if (statistics) statistics->rounds = round + 1;
        bool changed = false;
        if (round + 1 < most_rounds)
            for (const Cut& cut : cells_to_halve(mesh, origins, subdivision, at_middles * options.tolerance))
                changed |= subdivision.halve(cut.cell, cut.plane);
        if (changed) continue;
        drop_sheets(mesh, origins, 10 * subdivision.complex.tolerance);
        // What repair cannot help needs smaller cells around it.
        ++mending;
        if (!judge) judge.emplace(solid, mesh);
        const RepairStatistics repaired = repair(mesh, origins, *judge);
        if (repaired.left.size() < least_left) {
            least_left = repaired.left.size();
            farthest = repaired.farthest;
            best = mesh;
            best_origins = origins;
        }
        if (least_left == 0) break;
        for (const Cut& cut : cells_around(mesh, origins, repaired.left, subdivision))
            changed |= subdivision.halve(cut.cell, cut.plane);
        if (!changed) break;
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
