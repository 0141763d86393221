// Chooses where a cell of the BSP is split: the surface-area heuristic [MacDonald & Booth 1990] over the cost of local
// CSG.
//
// Costs are in units of one visit of an inner node, about 5 ns.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "bounds/solid_range.hpp"

namespace deburr {

// Costs of visiting an inner node and of intersecting a plane. A cell that costs no more than both is not split.
constexpr double cost_node = 1.0, cost_flat = 3.0;
// A cell with at most this many half-spaces is split by pruning the solids to the halves of every candidate; a larger
// one by the ends of the solids' boxes, unless it holds one solid only.
constexpr int few_half_spaces = 48;
// A cell with fewer half-spaces is split without parallel tasks.
constexpr int half_spaces_of_a_task = 200;

/// A solid's part in a cell.
struct BspItem {
    int solid = 0;                          // index among the BSP's solids
    std::shared_ptr<const SolidTree> tree;  // pruned to the cell or to one around it
    Box box;                                // of the whole solid
    LocalSolidSize size;                    // of the part in the cell
};

/// The expected cost of a ray that passes through a cell.
struct BspCost {
    double cost = 0;
    int half_spaces = 0;  // sum over the cell's items
};
BspCost cost_of(const std::vector<BspItem>& items);

/// A split plane across an axis, and the expected cost of a ray that passes through the cell after that split. Axis −1:
/// no split.
struct BspSplit {
    double cost = infinity, position = 0;
    int axis = -1;
};

/// The half of a cell above (`upper`) or below a plane across an axis.
inline Box half_of(const Box& cell, int axis, double position, bool upper) {
    Box half = cell;
    (upper ? half.lo : half.hi)[axis] = position;
    return half;
}

/// Whether there is one item, a rounded triangle mesh alone (a field that is a density).
bool is_model(const std::vector<BspItem>& items);

/// Chooses the splits of one BSP's cells.
class BspSplitter {
public:
    BspSplitter() = default;
    /// `world` bounds the space in which rays are expected, cells are inflated by `margin`, and no slice thinner than
    /// `smallest` is cut off (all in the solids' coordinates).
    BspSplitter(const Box& world, double margin, double smallest)
        : world_(world), margin_(margin), smallest_(smallest) {}

    /// The split of least expected cost, even if that is more than the cell's own. `half_spaces` is the sum over the
    /// items.
    BspSplit best(const Box& cell, const std::vector<BspItem>& items, int half_spaces) const;

    /// The least reduction of a cell's cost for which a split is worth its construction.
    double least_gain(const Box& cell, const std::vector<BspItem>& items) const;

    /// Whether the item's box does not meet the inflated cell.
    bool misses(const BspItem& item, const Box& cell) const {
        return intersection(item.box, inflated(cell, margin_)).empty();
    }

private:
    struct Trial;

    // Half the surface area of the part of a cell that is in `world`.
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
