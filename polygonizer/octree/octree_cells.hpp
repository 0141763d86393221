// The octree in which surface points are searched for [Vyatkin §3.2].
//
// A cube around the object is cut into eight, recursively. A part that is provably on one side of the surface is not
// cut; what is left at the wanted level are the cells that the surface may pass. The solid is pruned to the cell on the
// way down, as the paper halves the coefficients of its equation (4), so a cell evaluates only what matters in it.
//
// Corners have integer coordinates in units of the finest possible cell. Each corner is evaluated once, so all cells
// agree on its side.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "polygonizer/mesh/cancel.hpp"
#include "polygonizer/mesh/surface_distance.hpp"

namespace deburr {

/// A corner of the finest grid, in units.
using GridPoint = std::array<int, 3>;

/// A cell of the octree.
struct OctreeCell {
    GridPoint at;       // lower corner
    int size;           // length of a side in units
    int children = -1;  // the first of eight; −1: a leaf
    int solid = 0;      // index of the pruned solid to evaluate in it (CellTree::solid)
    bool open = false;  // whether the surface may pass it
};

/// The octree of a solid in a box. Not for several threads at once.
class CellTree {
public:
    /// Makes cells of side `edge` where the surface may be; they can be split `spare` more times. Throws
    /// std::length_error for more than max_cells cells or more than `max_open` leaves that the surface may pass, and
    /// Cancelled; so does split().
    CellTree(const SolidTree& solid, const Box& box, double edge, int spare, CancelFlag cancel = nullptr,
             std::size_t max_open = max_cells);

    static constexpr std::size_t max_cells = 100'000'000;

    const std::vector<OctreeCell>& cells() const { return cells_; }
    const OctreeCell& cell(int i) const { return cells_[i]; }
    /// Cuts a leaf into eight; false, without a change, if it is as small as possible.
    bool split(int leaf);
    /// The cell that holds the unit cube at this corner: the leaf, or the cell of at least this size (in units) above
    /// it; −1 outside of the root.
    int find(const GridPoint& unit, int size = 1) const;
    /// The leaf that holds x, or the one nearest to it.
    int find(Vec3 x) const;

    /// A grid corner in world space.
    Vec3 position(const GridPoint& c) const { return origin_ + unit_ * Vec3(c[0], c[1], c[2]); }
    Box box(const OctreeCell& c) const {
        return {position(c.at), position({c.at[0] + c.size, c.at[1] + c.size, c.at[2] + c.size})};
    }
    /// Length of a unit in world space.
    double unit() const { return unit_; }
    /// Side of the wanted cells in world space.
    double edge() const { return edge_; }
    /// 2^level wanted cells are as long as the root.
    int level() const { return level_; }
    /// The solid pruned to a cell and what is near it.
    const SignedDistance& solid(const OctreeCell& c) const { return *solids_[c.solid]; }
    /// The solid pruned to the leaf at x and what is near it.
    const SignedDistance& solid(Vec3 x) const { return solid(cell(find(x))); }
    /// The solid pruned to the box and what is near it.
    std::shared_ptr<const SignedDistance> solid(const Box& box) const;
    /// The signed distance at a grid corner, > 0 inside. It is evaluated in the leaf `by` unless it is known.
    double value(const GridPoint& c, const OctreeCell& by);

    /// The number of evaluations of a range so far.
    std::size_t range_tests = 0;

private:
    void add_children(int parent);

    CancelFlag cancel_;
    std::size_t max_open_, open_ = 1;
    Vec3 origin_;
    double edge_, unit_;
    int level_;
    std::vector<OctreeCell> cells_;
    std::vector<std::shared_ptr<const SignedDistance>> solids_;
    std::unordered_map<std::uint64_t, double> values_;
};

}  // namespace deburr
