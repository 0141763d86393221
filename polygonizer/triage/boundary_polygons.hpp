// The polygons between cells inside and cells outside, joined to a closed surface.
//
// Around every edge, the two polygons that bound one wedge of the solid are twins. A mesh vertex is a cycle of polygon
// corners joined by twins, so the surface is a 2-manifold, whatever touches.
#pragma once
#include "polygonizer/mesh/facets.hpp"
#include "polygonizer/triage/subspace.hpp"

namespace deburr {

/// A face between a cell inside and a cell outside, or outside of the complex.
struct Polygon {
    int face, inner, outer;  // face of the complex; the cells on its two sides
    int leaf;  // leaf whose isosurface it is; −1: on a plane; Origin::wall: beside a cell that was not polygonized
    int material;
    int first = 0, count = 0;  // its range of half-edges
    Vec3 normal{0.0};          // unit, outward
    /// The plane of the polygon is normal·x = offset.
    double offset = 0;
};

/// The half-edge structure of the polygons, a base for surface extraction. Keeps references to its arguments.
class BoundaryPolygons {
protected:
    BoundaryPolygons(const Subspace& subspace, const SolidTree& solid);

    int next(int h) const {
        const Polygon& p = polygons_[owner_[h]];
        return h + 1 < p.first + p.count ? h + 1 : p.first;
    }
    int previous(int h) const {
        const Polygon& p = polygons_[owner_[h]];
        return h > p.first ? h - 1 : p.first + p.count - 1;
    }

    const Subspace& subspace_;
    const CellComplex& complex_;
    const SolidTree& solid_;
    std::vector<Polygon> polygons_;
    std::vector<CellComplex::Step> steps_;    // step of each half-edge, polygon after polygon
    std::vector<int> owner_, twin_, vertex_;  // by half-edge: its polygon; its twin; the vertex where it starts
    /// By mesh vertex.
    std::vector<Vec3> positions_;

private:
    int material(int face, int inner, int outer) const;
    void collect();
    int half_edge(int polygon, int edge) const;
    void pair();
    void number_vertices();

    bool one_material_ = true;
    std::vector<int> polygon_of_;  // by face of the complex; −1: none
};

}  // namespace deburr
