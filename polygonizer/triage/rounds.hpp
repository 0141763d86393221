// What rounds of refinement do to the cells of a subdivision, and to what is polygonized in them.
//
// Where cells were halved, only they and their neighbours are polygonized, refined and mended again, and halved on as
// long as that helps. So a round of the whole solid, which makes the mesh, finds little or nothing left to do. Walls
// close the mesh of some cells where they end (surface.hpp), so that all that works on closed meshes works on it;
// triangles that touch walls are not asked.
#pragma once
#include <utility>

#include "polygonizer/mesh/facet_judge.hpp"
#include "polygonizer/mesh/good_facets.hpp"
#include "polygonizer/triage/refinement.hpp"

namespace deburr {

/// Of a tolerance, at the points of a triangle that are looked at: the rest is for what lies between, and for distances
/// being of first order.
constexpr double at_points = 0.85;

/// Halves every cell, through its middle where the cut passes it by: triangles that were split or flipped reach beyond
/// the cell that they came from. `by_planes`: the halves are cut on, as far as planes of their own go. Sheets that lie
/// in one plane, and part along a curve, cross again in halves, however small, until the curve is a border of cells.
/// The cells that came of those that could be cut.
std::vector<int> halve_all(Subdivision& subdivision, const std::vector<Cut>& cuts, bool by_planes = false);

/// Adds triangles that are farther from the surface than the tolerance; returns how many.
std::size_t add_far(const Mesh& mesh, const FacetJudge& judge, double tolerance, std::vector<int>& triangles);

/// Repairs a mesh that `refine` left with these triangles too far from the surface, and refines what its last
/// resort made too coarse. What is wrong with it then, sorted: what is too far now is too far in a mesh that
/// is thinned out, too. `patches` of the mesh follow.
std::vector<int> wrong_before_decimation(Mesh& mesh, std::vector<Origin>& origins, const FacetJudge& judge,
                                         double tolerance, const std::vector<int>& left, CancelFlag cancel,
                                         const GoodFacets* good = nullptr, Patches* patches = nullptr);

/// Those of the cuts that are not of the others' cells, or of neighbours of theirs.
std::vector<Cut> without_neighbours(std::vector<Cut> cuts, const std::vector<Cut>& others, const CellComplex& complex);

class LocalRounds {
public:
    /// No more cells are halved where there are `max_cells`. `slack` is that of a Subspace. Keeps references to all
    /// that is given.
    LocalRounds(Subdivision& subdivision, const SolidTree& solid, double slack, std::size_t max_cells,
                CancelFlag cancel)
        : subdivision_(subdivision), solid_(solid), slack_(slack), max_cells_(max_cells), cancel_(cancel) {}

    bool may_halve() const { return subdivision_.complex.cells.size() < max_cells_; }

    /// Facets that are near and do not lean. They must outlive this.
    void know(const GoodFacets& good) { good_ = &good; }

    /// Makes the cuts, and those that triangles of their halves need, so as not to lean, `most` times at most. How
    /// often.
    std::size_t cut_leaning(const std::vector<Cut>& cuts, std::size_t most) const;

    /// Makes the cuts, for `left` triangles that `refine` left farther from the surface than `near`, and those that
    /// such triangles of their halves need, as long as there is less than half of them. A finite tolerance: what is
    /// wrong in the halves by wrong_before_decimation is mended, too. Whether any was made.
    bool cut_far(const std::vector<Cut>& cuts, const FacetJudge& judge, double near, std::size_t left,
                 double tolerance = infinity);
    /// Makes the cuts by halve_all, for `wrong` triangles of wrong_before_decimation, and those around such triangles
    /// of the halves, as long as they become fewer. Whether any was made.
    bool mend(std::vector<Cut> cuts, const FacetJudge& judge, double tolerance, std::size_t wrong);

    /// Those of the cuts that are not of cells, or beside cells, that cut_far was given and did not help.
    std::vector<Cut> hopeful_far(std::vector<Cut> cuts) const { return hopeful(std::move(cuts), far_given_up_); }
    /// The same of mend.
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
    std::vector<char> far_given_up_, wrong_given_up_;  // by cell
};

}  // namespace deburr
