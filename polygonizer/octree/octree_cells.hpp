// The octree that surface points are looked for in [Vyatkin §3.2].
//
// A cube around the object is cut into eight again and again; a part that provably lies on one side
// of the surface is let go, what is left at the wanted level are the cells that the surface may pass.
// What the solid is over a cell is pruned on the way down, as the paper halves the coefficients of
// its equation (4), so that a cell evaluates only what reaches it.
//
// Corners have whole coordinates in units of the finest cell that may ever be; each is evaluated
// once, so that all cells agree on its side.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "polygonizer/mesh/cancel.hpp"
#include "polygonizer/mesh/surface_distance.hpp"

namespace deburr {

using GridPoint = std::array<int, 3>;

struct OctreeCell {
    GridPoint at;       // lower corner
    int size;           // in units
    int children = -1;  // the first of eight; −1: a leaf
    int solid = 0;      // what to evaluate in it
    bool open = false;  // the surface may pass
};

class CellTree {
public:
    /// Cells of side `edge`, where the surface is; they may be split `spare` times more.
    /// Throws std::length_error past max_cells, or past `max_open` leaves that the surface may pass, and Cancelled; so
    /// does split().
    CellTree(const SolidTree& solid, const Box& box, double edge, int spare, CancelFlag cancel = nullptr,
             std::size_t max_open = max_cells);

    static constexpr std::size_t max_cells = 100'000'000;

    const std::vector<OctreeCell>& cells() const { return cells_; }
    const OctreeCell& cell(int i) const { return cells_[i]; }
    /// Cuts a leaf into eight; false if it is as small as may be.
    bool split(int leaf);
    /// The cell that holds the unit cube at this corner: the leaf, or one of this size above it; −1
    /// beyond the root.
    int find(const GridPoint& unit, int size = 1) const;
    int find(Vec3 x) const;

    Vec3 position(const GridPoint& c) const { return origin_ + unit_ * Vec3(c[0], c[1], c[2]); }
    Box box(const OctreeCell& c) const {
        return {position(c.at), position({c.at[0] + c.size, c.at[1] + c.size, c.at[2] + c.size})};
    }
    double unit() const { return unit_; }
    double edge() const { return edge_; }
    int level() const { return level_; }
    const SignedDistance& solid(const OctreeCell& c) const { return *solids_[c.solid]; }
    /// The part of the solid that matters in and around the octree's leaf at x.
    const SignedDistance& solid(Vec3 x) const { return solid(cell(find(x))); }
    /// The part of the solid that matters in the box.
    std::shared_ptr<const SignedDistance> solid(const Box& box) const;
    /// > 0 inside; evaluated in the leaf `by` if it is not known.
    double value(const GridPoint& c, const OctreeCell& by);

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
