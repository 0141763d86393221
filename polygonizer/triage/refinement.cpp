#include "polygonizer/triage/refinement.hpp"

#include <algorithm>
#include <ranges>

#include "polygonizer/mesh/polygon_triangles.hpp"
#include "polygonizer/triage/parallel_family.hpp"

namespace deburr {
namespace {

// A triangle with the outward normals at its corners.
struct Part {
    Vec3 x[3], normal[3];
};

// Keeps the most urgent cut of each cell.
void worst_of_each(std::vector<Cut>& cuts) {
    std::sort(cuts.begin(), cuts.end(),
              [](const Cut& a, const Cut& b) { return a.cell != b.cell ? a.cell < b.cell : a.error > b.error; });
    cuts.erase(std::unique(cuts.begin(), cuts.end(), [](const Cut& a, const Cut& b) { return a.cell == b.cell; }),
               cuts.end());
}

Part part_of(const Mesh& mesh, const Triangle& t) {
    Part part;
    for (std::size_t k = 0; k < 3; ++k) {
        part.x[k] = mesh.positions[t.vertex[k]];
        part.normal[k] = mesh.normals[t.normal[k]];
    }
    return part;
}

// The plane that halves the edge of the triangle along which the surface's normal turns most; it does not turn along a
// sweep.
Plane halving(const Part& part, const LocalDensity& density) {
    double most = -1;
    Plane plane{};
    Vec3 sweep(0.0);
    const bool swept = is_swept(density, sweep);
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t l = (k + 1) % 3;
        const Vec3 a = part.x[k], b = part.x[l];
        const double turn = glm::length(part.normal[k] - part.normal[l]);
        Vec3 along = b - a;
        if (swept) along -= sweep * glm::dot(sweep, along);
        if (turn <= most || glm::length(along) == 0) continue;
        most = turn;
        plane.normal = glm::normalize(along);
        plane.offset = glm::dot(plane.normal, 0.5 * (a + b));
    }
    return plane;
}

// Whether the triangle leans too far from the surface or is too far from it; `distance` becomes its distance.
bool is_wrong(const Part& part, const LocalDensity& density, double tolerance, double& distance) {
    // The least cosine between a triangle and the surface, 75°; below it the cell is halved.
    constexpr double min_cosine = 0.25;
    // Slivers leave leaning to repair.hpp, because halving does not help them.
    constexpr double sliver = 0.005;  // height over longest side
    Vec3 normal(0.0), center(0.0);
    double longest2 = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 d = part.x[k] - part.x[(k + 1) % 3];
        normal += part.normal[k];
        center += part.x[k] / 3.0;
        longest2 = std::max(longest2, glm::dot(d, d));
    }
    const Vec3 area = glm::cross(part.x[1] - part.x[0], part.x[2] - part.x[0]);
    const ValueGradient here = density.gradient_at(center);
    const double slope = glm::length(here.gradient), size = glm::length(area);
    const double side = glm::dot(here.gradient, normal) > 0 ? 1 : -1;
    const bool leans = size > sliver * longest2 && side * glm::dot(area, here.gradient) < min_cosine * size * slope;
    distance = slope > 0 ? std::abs(here.value - 0.5) / slope : 0;
    if (std::isfinite(tolerance))
        for (std::size_t k = 0; k < 3; ++k) {
            const ValueGradient middle = density.gradient_at(0.5 * (part.x[k] + part.x[(k + 1) % 3]));
            const double steep = glm::length(middle.gradient);
            if (steep > 0) distance = std::max(distance, std::abs(middle.value - 0.5) / steep);
        }
    return leans || distance > tolerance;
}

}  // namespace

std::vector<Cut> cells_to_halve(const Mesh& mesh, const std::vector<Origin>& origins, const Subdivision& subdivision) {
    std::vector<Cut> cuts;
    for (std::size_t k = 0; k < origins.size(); ++k) {
        if (origins[k].cell < 0) continue;
        const LocalDensity& density = *subdivision.open(origins[k].cell, origins[k].leaf)->density;
        const Part part = part_of(mesh, mesh.triangles[k]);
        double distance;
        if (is_wrong(part, density, infinity, distance))
            cuts.push_back({origins[k].cell, distance, halving(part, density)});
    }
    worst_of_each(cuts);
    return cuts;
}

std::vector<Cut> cells_to_halve(const Mesh& mesh, const std::vector<Origin>& origins, const std::vector<int>& triangles,
                                const Subdivision& subdivision) {
    std::vector<Cut> cuts;
    for (const int t : triangles) {
        const Origin& origin = origins[t];
        if (origin.cell < 0) continue;
        const LocalDensity& density = *subdivision.open(origin.cell, origin.leaf)->density;
        const Triangle& triangle = mesh.triangles[t];
        const Plane plane = halving(part_of(mesh, triangle), density);
        if (plane.normal != Vec3(0.0)) cuts.push_back({origin.cell, glm::length(mesh.area_vector(triangle)), plane});
    }
    worst_of_each(cuts);
    return cuts;
}

std::vector<Cut> cells_to_halve(const Subspace& subspace, double tolerance) {
    const CellComplex& complex = subspace.complex();
    std::vector<Cut> cuts;
    std::vector<std::vector<int>> loop(1);
    for (int f = 0; f < int(complex.faces.size()); ++f) {
        const int leaf = subspace.leaf_of(f);
        if (leaf < 0) continue;
        const auto& face = complex.faces[f];
        const bool back = subspace.inside(face.back);
        if (back == subspace.inside(face.front)) continue;
        const int inner = back ? face.back : face.front, cell = subspace.origin(inner);
        const LocalDensity& density = *subspace.open(inner, leaf)->density;
        loop[0] = complex.corners(f);
        Vec3 area = complex.area_vector(f);
        if (!back) {
            std::ranges::reverse(loop[0]);
            area = -area;
        }
        const double size = glm::length(area);
        const double outward = subspace.side(inner, leaf) == Side::outside ? 1 : -1;  // direction along the gradient
        for (const auto& t : triangles_of(loop, complex.vertices, size > 0 ? area / size : Vec3(0.0))) {
            Part part;
            for (std::size_t k = 0; k < 3; ++k) {
                part.x[k] = complex.vertices[t[k]];
                const Vec3 g = density.gradient_at(part.x[k]).gradient;
                const double slope = glm::length(g);
                part.normal[k] = slope > 0 ? g * (outward / slope) : Vec3(0.0);
            }
            double distance;
            if (is_wrong(part, density, tolerance, distance)) cuts.push_back({cell, distance, halving(part, density)});
        }
    }
    worst_of_each(cuts);
    return cuts;
}

std::vector<Cut> cells_around(const Mesh& mesh, const std::vector<Origin>& origins, const std::vector<int>& triangles,
                              const Subdivision& subdivision) {
    std::vector<char> near(mesh.positions.size(), false);
    for (const int t : triangles)
        for (const int v : mesh.triangles[t].vertex) near[v] = true;
    std::vector<Cut> cuts;
    for (std::size_t k = 0; k < origins.size(); ++k) {
        if (origins[k].cell < 0) continue;
        const Triangle& t = mesh.triangles[k];
        const auto count = std::count_if(t.vertex.begin(), t.vertex.end(), [&](int v) { return near[v]; });
        if (count < 2) continue;
        const Plane plane = halving(part_of(mesh, t), *subdivision.open(origins[k].cell, origins[k].leaf)->density);
        if (plane.normal != Vec3(0.0)) cuts.push_back({origins[k].cell, glm::length(mesh.area_vector(t)), plane});
    }
    worst_of_each(cuts);
    return cuts;
}

}  // namespace deburr
