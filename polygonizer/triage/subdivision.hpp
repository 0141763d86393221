// Polyhedral subdivision of space [Triage §4.2]: planes cut a box into convex cells until each lies inside or outside
// of every rounded density that matters there, or no plane is left to cut it.
//
// The planes are those of the half-spaces, h, and their parallels at ±r. A plane cuts a cell only if its half-space is
// not constant there and the cell is undecided, so planes stay local. A cell in which many half-spaces meet is first
// halved along an axis, which keeps the whole near n log n; polygons that this cuts apart are merged again
// (surface.hpp). A small cell in which several half-spaces vary is not cut further as soon as it is simple
// (simple_cell.hpp). A cell that is not simple is halved when no plane is left, so that no part of the surface lies
// wholly within it.
//
// Printed differently: the paper classifies by density classes (density_class.hpp). Ranges of ρ over the cell say at
// least as much, and see that a sum of two small densities is small.
#pragma once
#include <memory>
#include <stdexcept>
#include <string>

#include "bounds/local_density.hpp"
#include "bounds/solid_tree.hpp"
#include "polygonizer/mesh/cancel.hpp"
#include "polygonizer/mesh/work_progress.hpp"
#include "polygonizer/triage/cell_complex.hpp"

namespace deburr {

/// A rounded density in a cell where it is neither inside nor outside.
struct OpenLeaf {
    int leaf = 0;                                 // index in SolidTree::leaves
    std::shared_ptr<const DensityTree> tree;      // pruned to the cell; of a rounded mesh, its planes alone
    std::shared_ptr<const LocalDensity> density;  // of the tree or field; null while there are many half-spaces
    FieldPtr field = {};  // a rounded mesh that is not a density of few planes here, pruned; else null
};

/// A node of the binary space partition.
struct PartitionNode {
    int parent = -1;
    Side side = Side::straddling;                  // side of the solid
    std::vector<OpenLeaf> open;                    // in a cell: undecided leaves that matter
    std::vector<std::pair<int, Side>> classified;  // leaves that are decided here but not in the parent, sorted
    std::vector<SolidTreeNode> solid;              // in a cell: the solid as a function of its open leaves
};

/// Thrown where the solid would need too many cells as small as the filter.
struct TooManyCells : std::length_error {
    explicit TooManyCells(std::size_t cells)
        : std::length_error("expected a solid of fewer cells, got more than " + std::to_string(cells)) {}
};

/// Limits of a subdivision.
struct SubdivisionOptions {
    /// The greatest number of half-spaces in undecided cells; the default takes some 3 GB.
    std::size_t max_half_spaces = 4'000'000;
    CancelFlag cancel = nullptr;
    WorkProgress* progress = nullptr;  // advanced by one phase; may be null
};

/// The subdivision: a complex of cells, and a binary space partition whose leaves they are.
class Subdivision {
public:
    /// `box` should hold the solid, which is cut off by it otherwise. Throws TooManyCells and Cancelled.
    Subdivision(const SolidTree& solid, const Box& box, const SubdivisionOptions& options = {});

    CellComplex complex;
    ChunkedList<PartitionNode> nodes;
    std::vector<int> node_of;  // node of each cell

    /// The side of the leaf throughout the cell; straddling if it is undecided or does not matter.
    Side side(int cell, int leaf) const;
    /// The leaf in the cell if it is undecided there, else null.
    const OpenLeaf* open(int cell, int leaf) const;
    /// Cuts an undecided cell; both halves become cells. False, without a change, if the plane does not cut it.
    bool halve(int cell, const Plane& plane);
    /// Cuts the cell and the resulting cells as far as planes go. Throws TooManyCells and Cancelled.
    void subdivide(int cell);

private:
    // A cell with more half-spaces than this is halved along an axis first. Chosen near the minimum of the triangle
    // count over Lobb's figures.
    static constexpr std::size_t many = 14;

    // A half-space in the current cell: the ranges of its distance and of its density.
    struct Reach {
        const HalfSpace* half_space;
        Range distance, rho;
        int along;  // 1 or −1 if its normal is that of the planes under consideration or the opposite one, else 0
    };

    // A cell's size, and what is open in it.
    struct Extents {
        Box box;
        int axis = 0;              // the longest axis along which the density changes
        double size = 0;           // the cell's length along that axis
        double radius = infinity;  // the least filter radius > 0
        double width = 0;          // the greatest extent along the normal of a half-space,
        Plane widest{};            // and the plane that halves the cell there
        std::size_t half_spaces = 0;
        bool all_small = true;  // whether every leaf's density is ready to be evaluated
    };

    /// A plane that may cut the cell.
    struct Candidate {
        Plane plane;
        Range along;  // range of the cell along the plane's normal
        double bias;  // added to the cost
    };
    struct AlongNormal {
        Vec3 normal;
        Range along;
    };

    Range extent(Vec3 normal);
    Range distances(const HalfSpace& h);
    void range_over_cell(const std::vector<HalfSpace>& half_spaces);
    int add_node(int parent, int cell);
    OpenLeaf localize(const OpenLeaf& leaf, Side& side);
    OpenLeaf localize_field(const OpenLeaf& leaf, Side& side);
    static std::shared_ptr<const LocalDensity> density_of(const OpenLeaf& leaf);
    static bool make_densities(PartitionNode& node);
    bool choose(PartitionNode& node, Plane& plane);
    bool choose_outer(const PartitionNode& node, const Extents& cell, Plane& plane);
    bool choose_own(const PartitionNode& node, Plane& plane);
    void reach_of(const PartitionNode& node);
    bool choose_neutral(const PartitionNode& node, const Extents& cell, Plane& plane) const;
    bool is_simple_cell(const PartitionNode& node) const;
    bool shows_surface(const PartitionNode& node) const;
    Extents extents(const PartitionNode& node) const;
    void turn(const PartitionNode& node, Vec3 normal);
    double cost(const PartitionNode& node, double offset, bool above);
    bool is_refused(const Plane& plane) const;
    void visit(int cell);

    const SubdivisionOptions options_;
    std::size_t left_ = 0;                        // half-spaces in undecided cells that are finished
    std::pair<int, std::size_t> visited_{-1, 0};  // the current cell, and the number of cells when it was visited
    std::vector<Vec3> corners_;                   // of the current cell
    std::vector<AlongNormal> along_normals_;      // ranges of corners_ along normals that were asked for
    std::vector<Reach> reach_;                    // of the half-spaces of its densities, leaf by leaf
    std::vector<Candidate> candidates_;           // planes that may cut the current cell
    Vec3 turned_to_{0.0};                         // normal of the planes under consideration
    std::vector<std::vector<Plane>> refused_;     // by cell: planes that could not cut it
    int current_ = 0;
    std::vector<Range> ranges_;
    std::vector<Side> sides_;           // by open leaf
    std::vector<std::size_t> varying_;  // by open leaf: half-spaces that vary, those with reach_.along = 0
};

}  // namespace deburr
