#include "polygonizer/triage/cell_mesh.hpp"

#include <algorithm>
#include <map>

#include "polygonizer/mesh/polygon_triangles.hpp"
#include "polygonizer/triage/subspace.hpp"

namespace deburr {

Vec3 cell_middle(const CellComplex& complex, int cell) {
    const std::vector<int>& corners = complex.vertices_of(cell);
    Vec3 middle(0.0);
    for (const int v : corners) middle += complex.vertices[v] / double(corners.size());
    return middle;
}

Mesh cell_mesh(const CellComplex& complex, int cell, double scale, Vec3 offset) {
    Mesh mesh;
    std::map<int, int> known;
    const Vec3 middle = cell_middle(complex, cell);
    for (const int face : complex.cells[cell]) {
        std::vector<int> loop;
        for (const int v : complex.corners(face)) {
            const auto [at, is_new] = known.try_emplace(v, int(mesh.positions.size()));
            if (is_new) mesh.positions.push_back(middle + scale * (complex.vertices[v] - middle) + offset);
            loop.push_back(at->second);
        }
        // Loops run counter-clockwise seen from the front cell, so those of a front cell are reversed.
        Vec3 area = complex.area_vector(face);
        if (complex.faces[face].front == cell) {
            std::reverse(loop.begin(), loop.end());
            area = -area;
        }
        const double size = glm::length(area);
        if (size == 0) continue;
        const int normal = int(mesh.normals.size());
        mesh.normals.push_back(area / size);
        ++mesh.polygons;
        for (const auto& t : triangles_of({loop}, mesh.positions, area / size))
            mesh.triangles.push_back({t, {normal, normal, normal}, 0, 0});
    }
    return mesh;
}

DensityClass cell_class(const Subdivision& subdivision, int cell, int leaf, const DensityTree& density) {
    const Side side = subdivision.side(cell, leaf);
    if (side == Side::straddling) return DensityClass::unclassified;
    const std::vector<int>& corners = subdivision.complex.vertices_of(cell);
    std::vector<Range> ranges;
    for (const HalfSpace& h : density.half_spaces) {
        Range range{1, 0};
        for (const int v : corners) {
            const double rho = h.density(subdivision.complex.vertices[v]);
            range = {std::min(range.lo, rho), std::max(range.hi, rho)};
        }
        ranges.push_back(range);
    }
    const Range rho = density_range(density, ranges);
    // At a corner on an outer plane ρ differs from 0 or 1 by rounding only.
    if (side == Side::outside) return rho.hi > on_level ? DensityClass::low : DensityClass::zero;
    return rho.lo < 1 - on_level ? DensityClass::high : DensityClass::one;
}

}  // namespace deburr
