// Where a cell of the BSP is split: the surface-area heuristic [MacDonald & Booth 1990] over the cost of local CSG.
//
// Costs are in units of one visit of an inner node, some 5 ns.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "bounds/solid_range.hpp"

namespace deburr {

// Costs of a visit of an inner node, and of a plane. A cell that costs no more than both stays whole.
constexpr double cost_node = 1.0, cost_flat = 3.0;
// Cells with no more half-spaces than this are split by what would be left of the solids on either
// side; larger ones by the solids' boxes and by a few such looks.
constexpr int few_half_spaces = 48;
// Halves of a cell with fewer are not worth a task, nor are looks at fewer.
constexpr int half_spaces_of_a_task = 200;

/// One solid as far as it reaches into a cell.
struct BspItem {
    int solid = 0;
    std::shared_ptr<const SolidTree> tree;  // pruned to the cell or to one around it
    Box box;                                // of the solid
    LocalSolidSize size;                    // in the cell
};

/// What a ray that passes the cell costs, for all of these.
struct BspCost {
    double cost = 0;
    int half_spaces = 0;
};
BspCost cost_of(const std::vector<BspItem>& items);

/// A plane across an axis, and what a ray that passes the cell then costs; axis −1: none.
struct BspSplit {
    double cost = infinity, position = 0;
    int axis = -1;
};

/// The half of a cell below or above a plane across an axis.
inline Box half_of(const Box& cell, int axis, double position, bool upper) {
    Box half = cell;
    (upper ? half.lo : half.hi)[axis] = position;
    return half;
}

/// Whether the items are nothing but one model.
bool is_model(const std::vector<BspItem>& items);

class BspSplitter {
public:
    BspSplitter() = default;
    /// `world`: where rays are. `margin`: by which cells are inflated; `smallest`: the thinnest slice that is cut off.
    BspSplitter(const Box& world, double margin, double smallest)
        : world_(world), margin_(margin), smallest_(smallest) {}

    /// The split of a cell that is expected to cost least, however much that is. `half_spaces`: of all items.
    BspSplit best(const Box& cell, const std::vector<BspItem>& items, int half_spaces) const;

    /// What a split of the cell must spare of its cost, so as to be worth its making.
    double least_gain(const Box& cell, const std::vector<BspItem>& items) const;

    /// Whether the item's box and the cell's, which is inflated, are apart.
    bool misses(const BspItem& item, const Box& cell) const {
        return intersection(item.box, inflated(cell, margin_)).empty();
    }

private:
    struct Trial;

    // Area of the part of a cell that the scene can be seen through.
    double area(const Box& cell) const { return half_area(intersection(cell, world_)); }
    void consider(BspSplit& best, const Box& cell, int axis, double position, double low, double high) const;
    std::vector<double> candidates(const Box& cell, const std::vector<BspItem>& items, int axis) const;
    void add_ends(const BspItem& item, int axis, std::vector<double>& at) const;
    void evaluate(const Box& cell, const std::vector<BspItem>& items, std::span<Trial> trials) const;
    BspSplit best_local(const Box& cell, const std::vector<BspItem>& items, int half_spaces) const;
    BspSplit middle(const Box& cell, const BspItem& item) const;
    BspSplit best_of_boxes(const Box& cell, const std::vector<BspItem>& items) const;

    Box world_;
    double margin_ = 0, smallest_ = 0;
};

}  // namespace deburr
