// Rounds of refinement: they halve cells of a subdivision and polygonize them again.
//
// Where cells were halved, only they and their neighbours are polygonized, refined and mended again, and halved further
// as long as that helps. So a round of the whole solid, which makes the mesh, finds little or nothing left to do. Walls
// close the mesh of some cells where it ends (surface.hpp), so that everything that works on closed meshes works on it;
// triangles that touch walls are not judged.
#pragma once
#include <utility>

#include "polygonizer/mesh/facet_judge.hpp"
#include "polygonizer/mesh/good_facets.hpp"
#include "polygonizer/triage/refinement.hpp"

namespace deburr {

/// The fraction of a tolerance that is allowed at the tested points of a triangle. The rest is for what lies between
/// them, and for the error of first-order distances.
constexpr double at_points = 0.85;

/// Halves the cell of every cut: by the cut's plane or, if that misses the cell, through its middle, because triangles
/// that were split or flipped reach beyond the cell that they came from. With `by_planes` the halves are subdivided
/// further by the planes of their half-spaces: sheets that lie in one plane and part along a curve cross again in
/// halves, however small, until the curve is a border of cells. Returns the cells that resulted from those that could
/// be cut.
std::vector<int> halve_all(Subdivision& subdivision, const std::vector<Cut>& cuts, bool by_planes = false);

/// Appends the triangles that are farther from the surface than the tolerance; returns how many.
std::size_t add_far(const Mesh& mesh, const FacetJudge& judge, double tolerance, std::vector<int>& triangles);

/// Repairs a mesh in which refine() left the triangles `left` too far from the surface, and refines what the last
/// resort of repair made too coarse. Returns the triangles that are still wrong, sorted: those that are too far now are
/// so in a decimated mesh, too. Facets in `good` count as good, and `patches` of the mesh follow the changes. Throws
/// Cancelled.
std::vector<int> wrong_before_decimation(Mesh& mesh, std::vector<Origin>& origins, const FacetJudge& judge,
                                         double tolerance, const std::vector<int>& left, CancelFlag cancel,
                                         const GoodFacets* good = nullptr, Patches* patches = nullptr);

/// The cuts of cells that are neither cells of `others` nor their neighbours.
std::vector<Cut> without_neighbours(std::vector<Cut> cuts, const std::vector<Cut>& others, const CellComplex& complex);

/// Rounds of refinement in parts of a subdivision.
class LocalRounds {
public:
    /// No cell is halved once there are `max_cells` cells. `slack` is that of Subspace. Keeps references to the
    /// subdivision and the solid.
    LocalRounds(Subdivision& subdivision, const SolidTree& solid, double slack, std::size_t max_cells,
                CancelFlag cancel)
        : subdivision_(subdivision), solid_(solid), slack_(slack), max_cells_(max_cells), cancel_(cancel) {}

    /// Whether more cells may be halved.
    bool may_halve() const { return subdivision_.complex.cells.size() < max_cells_; }

    /// Sets the facets that are known to be near the surface and not to lean; the set must outlive this object.
    void know(const GoodFacets& good) { good_ = &good; }

    /// Makes the cuts, and further ones for triangles of the halves that lean, in at most `most` rounds. Returns the
    /// number of rounds in which cells were cut.
    std::size_t cut_leaning(const std::vector<Cut>& cuts, std::size_t most) const;

    /// Makes the cuts, for `left` triangles that refine() left farther from the surface than `near`, and further ones
    /// for such triangles of the halves, as long as their number at least halves. With a finite tolerance, triangles of
    /// the halves that wrong_before_decimation() finds are mended, too. Returns whether any cell was cut.
    bool cut_far(const std::vector<Cut>& cuts, const FacetJudge& judge, double near, std::size_t left,
                 double tolerance = infinity);
    /// Makes the cuts by halve_all(), for `wrong` triangles found by wrong_before_decimation(), and further ones around
    /// such triangles of the halves, as long as they become fewer. Returns whether any cell was cut.
    bool mend(std::vector<Cut> cuts, const FacetJudge& judge, double tolerance, std::size_t wrong);

    /// The cuts without those of cells for which, or beside which, cut_far() was tried in vain.
    std::vector<Cut> hopeful_far(std::vector<Cut> cuts) const { return hopeful(std::move(cuts), far_given_up_); }
    /// The cuts without those of cells for which, or beside which, mend() was tried in vain.
    std::vector<Cut> hopeful_wrong(std::vector<Cut> cuts) const { return hopeful(std::move(cuts), wrong_given_up_); }

private:
    struct Part;

    Part part_around(const std::vector<int>& cells) const;
    std::vector<int> halve_coarse(const std::vector<Cut>& cuts, double tolerance) const;
    static std::vector<Cut> hopeful(std::vector<Cut> cuts, const std::vector<char>& given_up);
    void give_up(std::vector<char>& given_up, const std::vector<int>& cells) const;

    Subdivision& subdivision_;
    const SolidTree& solid_;
    double slack_;
    std::size_t max_cells_;
    CancelFlag cancel_;
    const GoodFacets* good_ = nullptr;
    std::vector<char> far_given_up_, wrong_given_up_;  // by cell: whether halving did not help there
};

}  // namespace deburr
