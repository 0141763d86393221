// The polygons between cells inside and cells outside, joined to a closed surface.
//
// Around every edge the polygons that bound one wedge of the solid are twins there, and a mesh
// vertex is a cycle of polygon corners joined that way: a 2-manifold, whatever touches.
#pragma once
#include "polygonizer/mesh/facets.hpp"
#include "polygonizer/triage/subspace.hpp"

namespace deburr {

struct Polygon {
    int face, inner, outer;  // cells on either side
    int leaf;                // −1: on a plane; Origin::wall: beside a cell that was not polygonized
    int material;
    int first = 0, count = 0;  // its half-edges
    Vec3 normal{0.0};          // unit, outward
    double offset = 0;
};

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
    std::vector<CellComplex::Step> steps_;    // half-edges, polygon by polygon
    std::vector<int> owner_, twin_, vertex_;  // of a half-edge; vertex_: where it starts
    std::vector<Vec3> positions_;

private:
    int material(int face, int inner, int outer) const;
    void collect();
    int half_edge(int polygon, int edge) const;
    void pair();
    void number_vertices();

    bool one_material_ = true;
    std::vector<int> polygon_of_;  // of a face
};

}  // namespace deburr
