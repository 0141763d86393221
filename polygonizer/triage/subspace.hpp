// Subspace polygonization [Triage §4.4]: the isosurface ρ = ½ of one rounded density after the other cuts the cells
// that planes left undecided, until every cell is inside or outside of it.
//
// Every decision is made where it is shared, so neighbours cannot disagree:
//   edge   its ends' signs decide; a root splits it [§4.4.1]. An edge between inside and outside cells, or
//          along the surface, has no sign of its own, and a vertex on the surface never has one: no vertex
//          is classified against ½ + ε (§6.4), so no surface is missed there
//   face   segments join the points where the sign changes along its border, by the class of their
//          centroid [§4.4.2], and are refined once [§4.4.3]
//   cell   the faces inside and outside meet in a set of simple loops; each is spanned by a disc: flat, or
//          strips along a swept surface [§4.5.2], or a fan about a displaced centroid [§4.4.4]
// The surface itself is extracted later, between cells inside and cells outside (surface.hpp). So it is closed even
// where a sign was wrong or a disc ill-shaped.
#pragma once
#include <optional>

#include "polygonizer/triage/loop_disc.hpp"
#include "polygonizer/triage/subdivision.hpp"

namespace deburr {

// A point with |ρ − ½| at most this is on the surface, whatever the slope. Rounding errors are 10⁻¹⁵; with the slope of
// one half-space, ¾/r, it is a distance of 1.3·10⁻¹⁰ r.
constexpr double on_level = 1e-10;

/// A copy of a subdivision's cells that is cut by isosurfaces.
class Subspace {
public:
    /// Prepares all cells of the subdivision, to which it keeps a reference. Where only one leaf is undecided, segments
    /// and discs stay flat if they lean little and their middles are nearer to the surface than `slack`; surfaces of
    /// several leaves may touch, and are refined always.
    explicit Subspace(const Subdivision& subdivision, double slack = 0);
    /// Prepares only these cells, in increasing order, at a cost that does not depend on the number of others. The
    /// surface is right in cells all of whose neighbours are included.
    Subspace(const Subdivision& subdivision, std::span<const int> cells, double slack = 0);
    /// Cuts the cells by the isosurfaces of all leaves.
    void polygonize();

    const CellComplex& complex() const { return complex_; }
    /// Whether the cell is inside the solid. Valid after polygonize(), in cells that were polygonized.
    bool inside(int cell) const;
    /// Whether the cell was cut by all that matters in it, or nothing matters. Outside of the complex: whether all
    /// cells were.
    bool is_polygonized(int cell) const { return cell == CellComplex::outside ? whole_ : is_cut_[root_[cell]]; }
    /// The leaf whose isosurface the face is part of; −1 for faces on planes.
    int leaf_of(int face) const { return leaf_of_face_[face]; }
    /// The side of the leaf throughout the cell; straddling if it is undecided or does not matter.
    Side side(int cell, int leaf) const;
    /// The cell of the subdivision from which the cell was cut.
    int origin(int cell) const { return undivided_[root_[cell]]; }
    /// The leaf in the cell of the subdivision from which the cell was cut, if it was undecided there; else null.
    const OpenLeaf* open(int cell, int leaf) const { return subdivision_.open(origin(cell), leaf); }

private:
    using Step = CellComplex::Step;
    enum class Sign : signed char { below = -1, none = 0, above = 1, unknown = 2 };
    struct Border {  // an edge between a face outside and a face inside
        Step step;
        int outer, inner;
        bool used;
    };
    /// A simple loop on the border of a cell.
    struct Loop {
        CellComplex::List<12> steps;
        int seed;  // a face on the inner side
    };
    /// A leaf's side throughout a cell, found by cutting.
    struct Resolved {
        int leaf;
        Side side;
    };
    // Signs with respect to leaf_, of vertices, edges, faces or cells. They are all forgotten at once for the next
    // leaf.
    class Signs {
    public:
        Sign at(int i) const {
            const std::size_t k = std::size_t(i);
            return k < known_.size() && known_[k].turn == turn_ ? known_[k].sign : Sign::unknown;
        }
        void set(int i, Sign sign) {
            if (std::size_t(i) >= known_.size()) known_.resize(std::size_t(i) + 1 + known_.size() / 2);
            known_[i] = {turn_, sign};
        }
        void forget() { ++turn_; }

    private:
        struct Known {
            int turn = 0;
            Sign sign = Sign::unknown;
        };
        std::vector<Known> known_;
        int turn_ = 1;
    };

    void begin();
    double slack_in(int cell) const;
    void cut_by(int leaf, const std::vector<int>& open);
    Side side_now(int cell);
    Sign vertex_sign(int vertex, const LocalDensity& density);
    Sign edge_sign(int edge, const LocalDensity& density);
    Sign point_sign(Vec3 x, const LocalDensity& density) const;
    void split_edges(int face, const LocalDensity& density);
    void split_face(int face, const LocalDensity& density);
    Sign find_sign_changes(int face);
    Sign centroid_sign(std::span<const int> vertices, const LocalDensity& density) const;
    void cut_off(int face, int a, int b, Sign sign, const LocalDensity& density);
    bool is_straight_border(int face, int a, int b) const;
    std::optional<Vec3> refine(int face, int a, int b, const LocalDensity& density) const;
    bool search(int face, Vec3 middle, Vec3 line, Vec3 normal, double length, const LocalDensity& density,
                Vec3& root) const;
    Vec3 on_seam(std::span<const int> faces, Vec3 start, double reach, const LocalDensity& density) const;
    void find_loops(int cell);
    void span(int cell, const LocalDensity& density);
    int owner(int face, std::span<const int> family) const;

    const Subdivision& subdivision_;
    std::vector<int> undivided_;  // of a first cell: its number in the subdivision
    CellComplex complex_;
    double slack_;
    bool whole_;                // whether all cells are to be cut
    std::vector<char> is_cut_;  // of a first cell: whether it is to be cut, or decided
    int leaf_ = 0;
    std::vector<int> leaf_of_face_;
    std::vector<int> open_;                         // first cells that are to be cut
    std::vector<int> root_;                         // of a cell: the first cell from which it was cut
    std::vector<int> next_of_root_;                 // of a cell: another one cut from the same first cell, or −1
    std::vector<ShortList<Resolved, 2>> resolved_;  // by cell
    Signs vertex_signs_, edge_signs_, face_labels_;
    Signs sides_;  // of cells; none: straddling

    // Working data of the current cell or face.
    std::vector<Border> borders_;
    std::vector<Border*> path_;
    std::vector<Loop> loops_;
    std::vector<Wall> walls_;
    std::vector<int> rim_;
    std::vector<Vec3> points_;
    Disc disc_;
    std::vector<Sign> rim_signs_;
    std::vector<int> changes_;  // vertices
    std::vector<Sign> after_;   // the sign after each change
    mutable std::vector<char> in_;
};

/// A point between a and b where φ = ρ − ½ changes its sign. fa and fb are φ at a and b, and must have different signs.
Vec3 root_between(const LocalDensity& density, Vec3 a, double fa, Vec3 b, double fb);

}  // namespace deburr
