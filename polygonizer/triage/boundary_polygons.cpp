#include "polygonizer/triage/boundary_polygons.hpp"

#include <algorithm>

namespace deburr {

BoundaryPolygons::BoundaryPolygons(const Subspace& subspace, const SolidTree& solid)
    : subspace_(subspace), complex_(subspace.complex()), solid_(solid) {
    one_material_ = std::all_of(solid.leaves.begin(), solid.leaves.end(),
                                [&](const SolidLeaf& l) { return l.material == solid.leaves[0].material; });
    collect();
    pair();
    number_vertices();
}

/// The material of the polygon: that of its leaf, or else of a leaf that has the inner and outer cell on different
/// sides.
int BoundaryPolygons::material(int face, int inner, int outer) const {
    if (solid_.leaves.empty()) return 0;
    if (const int leaf = subspace_.leaf_of(face); leaf >= 0) return solid_.leaves[leaf].material;
    if (!one_material_)
        for (std::size_t k = 0; k < solid_.leaves.size(); ++k) {
            const Side a = subspace_.side(inner, int(k)), b = subspace_.side(outer, int(k));
            if (a != b && a != Side::straddling && (b != Side::straddling || outer < 0))
                return solid_.leaves[k].material;
        }
    return solid_.leaves[0].material;
}

void BoundaryPolygons::collect() {
    std::vector<char> in;
    for (std::size_t c = 0; c < complex_.cells.size(); ++c) in.push_back(subspace_.inside(int(c)));
    const auto is_in = [&](int cell) { return cell >= 0 && in[cell]; };
    std::size_t polygons = 0, steps = 0;
    for (std::size_t f = 0; f < complex_.faces.size(); ++f) {
        const auto& face = complex_.faces[f];
        if (is_in(face.back) == is_in(face.front)) continue;
        ++polygons;
        steps += face.loop.size();
    }
    polygons_.reserve(polygons);
    steps_.reserve(steps);
    owner_.reserve(steps);
    polygon_of_.assign(complex_.faces.size(), -1);
    for (std::size_t f = 0; f < complex_.faces.size(); ++f) {
        const auto& face = complex_.faces[f];
        const bool back = is_in(face.back);
        if (back == is_in(face.front)) continue;
        Polygon p{int(f), back ? face.back : face.front, back ? face.front : face.back, subspace_.leaf_of(int(f)), 0};
        if (!subspace_.is_polygonized(p.inner) || !subspace_.is_polygonized(p.outer)) p.leaf = Origin::wall;
        p.material = material(int(f), p.inner, p.outer);
        p.first = int(steps_.size());
        p.count = int(face.loop.size());
        if (back)
            steps_.insert(steps_.end(), face.loop.begin(), face.loop.end());
        else
            for (auto s = face.loop.end(); s != face.loop.begin();) steps_.push_back(*--s ^ 1);
        const Vec3 area = complex_.area_vector(int(f)) * (back ? 1.0 : -1.0);
        if (glm::length(area) > 0) p.normal = glm::normalize(area);
        p.offset = glm::dot(p.normal, complex_.vertices[complex_.start(steps_[p.first])]);
        polygon_of_[f] = int(polygons_.size());
        for (int k = 0; k < p.count; ++k) owner_.push_back(int(polygons_.size()));
        polygons_.push_back(p);
    }
}

int BoundaryPolygons::half_edge(int polygon, int edge) const {
    const Polygon& p = polygons_[polygon];
    for (int h = p.first; h < p.first + p.count; ++h)
        if (steps_[h] >> 1 == edge) return h;
    return -1;
}

// Makes half-edges twins that bound the same wedge of the solid around their edge.
void BoundaryPolygons::pair() {
    twin_.assign(steps_.size(), -1);
    for (std::size_t h = 0; h < steps_.size(); ++h) {
        if (twin_[h] >= 0) continue;
        const Polygon& p = polygons_[owner_[h]];
        const int edge = steps_[h] >> 1;
        int face = p.face, cell = p.inner;
        do {
            face = complex_.across(edge, face, cell);
            if (polygon_of_[face] >= 0) break;
            cell = complex_.neighbour(face, cell);
        } while (true);
        const int other = half_edge(polygon_of_[face], edge);
        twin_[h] = other;
        twin_[other] = int(h);
    }
}

void BoundaryPolygons::number_vertices() {
    vertex_.assign(steps_.size(), -1);
    for (std::size_t h = 0; h < steps_.size(); ++h) {
        if (vertex_[h] >= 0) continue;
        const int fresh = int(positions_.size());
        positions_.push_back(complex_.vertices[complex_.start(steps_[h])]);
        int at = int(h);
        do {
            vertex_[at] = fresh;
            at = twin_[previous(at)];
        } while (at != int(h));
    }
}

}  // namespace deburr
