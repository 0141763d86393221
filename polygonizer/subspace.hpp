// Subspace polygonization [Triage §4.4]: the isosurface ρ = ½ of one rounded density cuts the cells
// that planes left undecided, until every cell is inside or outside of it.
//
// Everything is decided where it is shared, so neighbours cannot disagree:
//   edge   its ends' signs; a root splits it [§4.4.1]. An edge between inside and outside cells, or
//          along the surface, has no sign of its own, and a vertex on the surface never has one:
//          no vertex is classified against ½ + ε (§6.4), so no surface is missed there
//   face   segments join the places where its rim changes sign, by the class of their centroid
//          [§4.4.2], and are refined once [§4.4.3]
//   cell   where faces inside and outside meet is a set of simple loops; each is spanned by a disc:
//          flat, or strips along a swept surface [§4.5.2], or a fan about a displaced centroid
//          [§4.4.4]
// The surface itself is read off later, between cells inside and cells outside (surface.hpp). So it
// is closed even where a sign was wrong or a disc ill-shaped.
#pragma once
#include "polygonizer/subdivision.hpp"

namespace deburr {

// |ρ − ½| below which a point is on the surface whatever the slope: rounding leaves 10⁻¹⁵, and
// where the slope is that of one half-space, ¾/r, it is a distance of 1.3·10⁻¹⁰ r.
constexpr double on_level = 1e-10;

class Subspace {
public:
    explicit Subspace(Subdivision& subdivision);
    /// Cuts by the isosurfaces of all leaves.
    void polygonize();

    /// Whether the cell is inside the solid; right after polygonize().
    bool inside(int cell) const;
    /// The leaf whose isosurface the face is a part of; -1 for faces on planes.
    int leaf_of(int face) const { return leaf_of_face_[std::size_t(face)]; }
    /// Side of the leaf throughout the cell; straddling where it was never asked.
    Side side(int cell, int leaf) const;
    /// The undivided cell of the subdivision that the cell was cut from.
    int origin(int cell) const { return origin_[std::size_t(cell)]; }

private:
    using Step = CellComplex::Step;
    enum class Sign : signed char { below = -1, none = 0, above = 1, unknown = 2 };
    struct Loop {
        std::vector<Step> steps;
        int seed;  // a face on the inner side
    };

    void cut_by(int leaf);
    Sign vertex_sign(int vertex, const LocalDensity& density);
    Sign edge_sign(int edge, const LocalDensity& density);
    Sign point_sign(Vec3 x, const LocalDensity& density) const;
    void split_edges(int face, const LocalDensity& density);
    void split_face(int face, const LocalDensity& density);
    bool refine(int face, int a, int b, const LocalDensity& density, std::vector<Vec3>& between);
    bool search(int face, Vec3 middle, Vec3 line, Vec3 normal, double length, const LocalDensity& density,
                Vec3& root) const;
    Vec3 on_seam(const std::vector<int>& faces, Vec3 start, double reach, const LocalDensity& density) const;
    std::vector<Loop> loops(int cell);
    void span(int cell, const LocalDensity& density);
    int owner(int face, const std::vector<int>& family) const;
    void label(int face, Sign sign);
    Sign label_of(int face) const { return face_label_[std::size_t(face)]; }

    Subdivision& subdivision_;
    CellComplex& complex_;
    int leaf_ = 0;
    std::vector<int> leaf_of_face_, origin_;
    std::vector<std::vector<std::pair<int, Side>>> resolved_;  // by cell
    std::vector<Sign> vertex_sign_, edge_sign_, face_label_;   // with respect to leaf_
};

/// Where φ = ρ − ½ changes its sign on the way from a to b; it must.
Vec3 root_between(const LocalDensity& density, Vec3 a, double fa, Vec3 b, double fb);

}  // namespace deburr
