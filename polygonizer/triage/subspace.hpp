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
#include <optional>

#include "polygonizer/triage/loop_disc.hpp"
#include "polygonizer/triage/subdivision.hpp"

namespace deburr {

// |ρ − ½| below which a point is on the surface whatever the slope: rounding leaves 10⁻¹⁵, and
// where the slope is that of one half-space, ¾/r, it is a distance of 1.3·10⁻¹⁰ r.
constexpr double on_level = 1e-10;

class Subspace {
public:
    /// Keeps a reference to the subdivision, and cuts a copy of its cells.
    /// Segments and discs that are nearer to the surface than `slack` at their middles, and lean little, stay flat,
    /// where only one leaf is undecided: surfaces of several may touch.
    explicit Subspace(const Subdivision& subdivision, double slack = 0);
    /// Of some cells of the subdivision, in rising order, only: what it costs does not depend on how many there are
    /// besides. The surface is right in cells whose neighbours are included, too.
    Subspace(const Subdivision& subdivision, std::span<const int> cells, double slack = 0);
    /// Cuts by the isosurfaces of all leaves.
    void polygonize();

    const CellComplex& complex() const { return complex_; }
    /// Whether the cell is inside the solid; right after polygonize(), but for cells that were not polygonized.
    bool inside(int cell) const;
    /// Whether all that matters in the cell was cut, or nothing does. What is outside of a part of the cells was not.
    bool is_polygonized(int cell) const { return cell == CellComplex::outside ? whole_ : is_cut_[root_[cell]]; }
    /// The leaf whose isosurface the face is a part of; -1 for faces on planes.
    int leaf_of(int face) const { return leaf_of_face_[face]; }
    /// Side of the leaf throughout the cell; straddling where it was never asked.
    Side side(int cell, int leaf) const;
    /// The undivided cell of the subdivision that the cell was cut from.
    int origin(int cell) const { return undivided_[root_[cell]]; }
    /// The leaf where the cell was cut from, if it was undecided there.
    const OpenLeaf* open(int cell, int leaf) const { return subdivision_.open(origin(cell), leaf); }

private:
    using Step = CellComplex::Step;
    enum class Sign : signed char { below = -1, none = 0, above = 1, unknown = 2 };
    struct Border {  // where a face outside and one inside meet
        Step step;
        int outer, inner;
        bool used;
    };
    struct Loop {
        CellComplex::List<12> steps;
        int seed;  // a face on the inner side
    };
    struct Resolved {
        int leaf;
        Side side;
    };
    // Signs with respect to leaf_: forgotten all at once when the next leaf's turn comes.
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
    std::optional<Vec3> refine(int face, int a, int b, const LocalDensity& density) const;
    bool search(int face, Vec3 middle, Vec3 line, Vec3 normal, double length, const LocalDensity& density,
                Vec3& root) const;
    Vec3 on_seam(std::span<const int> faces, Vec3 start, double reach, const LocalDensity& density) const;
    void find_loops(int cell);
    void span(int cell, const LocalDensity& density);
    int owner(int face, std::span<const int> family) const;

    const Subdivision& subdivision_;
    std::vector<int> undivided_;  // of a cell that was there first: the subdivision's
    CellComplex complex_;
    double slack_;
    bool whole_;                // all cells are cut
    std::vector<char> is_cut_;  // a cell that was there first is cut, or decided
    int leaf_ = 0;
    std::vector<int> leaf_of_face_;
    std::vector<int> open_;                         // cells that were there first, and are cut
    std::vector<int> root_;                         // of a cell: the one that it was cut from
    std::vector<int> next_of_root_;                 // of a cell: another that was cut from the same, or −1
    std::vector<ShortList<Resolved, 2>> resolved_;  // by cell
    Signs vertex_signs_, edge_signs_, face_labels_;
    Signs sides_;  // of cells: above, below, none for straddling

    // Of the cell or face that is being looked at.
    std::vector<Border> borders_;
    std::vector<Border*> path_;
    std::vector<Loop> loops_;
    std::vector<Wall> walls_;
    std::vector<int> rim_;
    std::vector<Vec3> points_;
    Disc disc_;
    std::vector<Sign> rim_signs_, after_;
    std::vector<int> changes_;
    mutable std::vector<char> in_;
};

/// Point between a and b at which φ = ρ − ½ changes its sign. Precondition: φ has different signs at a and b.
Vec3 root_between(const LocalDensity& density, Vec3 a, double fa, Vec3 b, double fb);

}  // namespace deburr
