#include "polygonizer/triage.hpp"

#include <algorithm>

#include "bounds/bounding_box.hpp"
#include "polygonizer/repair.hpp"
#include "polygonizer/sharp_parts.hpp"
#include "polygonizer/surface.hpp"

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

// Cells whose part of the mesh leans too far from the surface's normal, or is too far from it.
std::vector<int> cells_to_halve(const Mesh& mesh, const std::vector<Origin>& origins,
                                const Subdivision& subdivision, double tolerance) {
    // Cosine between a triangle and the surface below which its cell is halved: 75°.
    constexpr double least_cosine = 0.25;
    std::vector<int> cells;
    for (std::size_t k = 0; k < origins.size(); ++k) {
        if (origins[k].cell < 0) continue;
        const Triangle& t = mesh.triangles[k];
        const Vec3 area = mesh.area_vector(t);
        Vec3 normal(0.0), centre(0.0);
        for (std::size_t j = 0; j < 3; ++j) {
            normal += mesh.normals[std::size_t(t.normal[j])];
            centre += mesh.positions[std::size_t(t.vertex[j])] / 3.0;
        }
        const ValueGradient here =
            subdivision.open(origins[k].cell, origins[k].leaf)->density->gradient_at(centre);
        const double slope = glm::length(here.gradient), size = glm::length(area);
        const double side = glm::dot(here.gradient, normal) > 0 ? 1 : -1;
        // A sliver leans for other reasons, which halving does not help: repair.hpp.
        constexpr double sliver = 0.005;  // height over longest side
        double longest2 = 0;
        for (std::size_t j = 0; j < 3; ++j) {
            const Vec3 d = mesh.positions[std::size_t(t.vertex[j])] - mesh.positions[std::size_t(t.vertex[(j + 1) % 3])];
            longest2 = std::max(longest2, glm::dot(d, d));
        }
        const bool leans = size > sliver * longest2 && side * glm::dot(area, here.gradient) < least_cosine * size * slope;
        const bool far = std::abs(here.value - 0.5) > tolerance * slope;
        if (leans || far) cells.push_back(origins[k].cell);
    }
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    return cells;
}

// Across its longest side; false if it is too small to be worth it.
bool halve(Subdivision& subdivision, int cell, std::size_t round) {
    std::vector<int> vertices;
    subdivision.complex.vertices_of(cell, vertices);
    Box box;
    for (const int v : vertices) {
        const Vec3 x = subdivision.complex.vertices[std::size_t(v)];
        box = hull(box, Box{x, x});
    }
    const Vec3 size = box.hi - box.lo;
    int axis = int(round % 3);
    for (int k = 0; k < 3; ++k)
        if (size[k] > 1.2 * size[axis]) axis = k;
    if (size[axis] < 1e4 * subdivision.complex.tolerance) return false;
    Plane plane{Vec3(0.0), 0.5 * (box.lo[axis] + box.hi[axis])};
    plane.normal[axis] = 1;
    return subdivision.halve(cell, plane);
}

}  // namespace

Mesh triage(const SolidTree& mixed, const Box& box, const TriageOptions& options, TriageStatistics* statistics) {
    if (box.empty()) return {};
    const SolidTree solid = separate_sharp(mixed);
    Subdivision subdivision(solid, box);
    Mesh mesh;
    // Each round halves the cells that need it; a surface that bends by 90° within a cell is within
    // any tolerance that matters, or has come down to the smallest cells, long before.
    constexpr std::size_t most_rounds = 5;
    for (std::size_t round = 0; round < most_rounds; ++round) {
        Subdivision work = subdivision;
        Subspace subspace(work);
        subspace.polygonize();
        std::vector<Origin> origins;
        mesh = surface(subspace, work, solid, &origins);
        if (statistics) statistics->rounds = round + 1;
        bool changed = false;
        for (const int cell : cells_to_halve(mesh, origins, subdivision, options.tolerance))
            changed |= halve(subdivision, cell, round);
        if (!changed) break;
    }
    const OffsetField offset(solid, box);
    repair(mesh, offset);
    thin_borders(mesh, offset);
    if (statistics) {
        statistics->cells = subdivision.complex.cells.size();
        statistics->open_cells = 0;
        for (const int place : subdivision.place_of)
            statistics->open_cells += subdivision.places[std::size_t(place)].side == Side::straddling;
    }
    return mesh;
}

}  // namespace deburr
