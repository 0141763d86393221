// Polyhedral subdivision of space [Triage §4.2]: planes cut a box into convex cells until each lies
// inside or outside of every rounded density that matters there, or no plane is left to cut it.
//
// The planes are those of the half-spaces, h, and their parallels at ±r. A plane cuts a cell only
// if its half-space is not constant there and the cell is not decided, so planes stay local. Where
// many half-spaces meet in a cell it is halved first, along an axis, which keeps the whole near
// n log n; the polygons that this cuts apart are joined again (surface.hpp). A small cell in which
// several half-spaces vary is left as soon as it is simple (simple_cell.hpp), and one that is not
// simple is halved when no plane is left, so that no part of the surface lies whole within.
//
// Printed differently: the paper classifies by density classes (density_class.hpp). Ranges of ρ
// over the cell say at least as much, and see that a sum of two small densities is small.
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

/// A rounded density in a place where it is neither inside nor outside.
struct OpenLeaf {
    int leaf = 0;                                 // in SolidTree::leaves
    std::shared_ptr<const DensityTree> tree;      // pruned to the place; of a rounded mesh, its planes alone
    std::shared_ptr<const LocalDensity> density;  // of it; null while it has many half-spaces
    FieldPtr field = {};                          // a rounded mesh that is no density of few planes here, pruned
};

/// A node of the binary space partition.
struct PartitionNode {
    int parent = -1;
    Side side = Side::straddling;                  // of the solid
    std::vector<OpenLeaf> open;                    // of a cell: leaves that are undecided, and matter
    std::vector<std::pair<int, Side>> classified;  // leaves decided here but not in the parent, sorted
    std::vector<SolidTreeNode> solid;              // of a cell: the solid as a function of its open leaves
};

/// Thrown where cells that are as small as a filter would be too many for the size of the solid.
struct TooManyCells : std::length_error {
    explicit TooManyCells(std::size_t cells)
        : std::length_error("expected a solid of fewer cells, got more than " + std::to_string(cells)) {}
};

struct SubdivisionOptions {
    /// Of those that are left in open cells no more are looked after; of the default some 3 GB.
    std::size_t max_half_spaces = 4'000'000;
    CancelFlag cancel = nullptr;
    WorkProgress* progress = nullptr;  // advanced by a phase; null: nobody asks
};

class Subdivision {
public:
    /// `box` should hold the solid; where it does not, the solid is cut off by it. Throws TooManyCells and Cancelled.
    Subdivision(const SolidTree& solid, const Box& box, const SubdivisionOptions& options = {});

    CellComplex complex;
    ChunkedList<PartitionNode> nodes;
    std::vector<int> node_of;  // of each cell

    /// Side of the leaf throughout the cell; straddling also where nobody asked.
    Side side(int cell, int leaf) const;
    const OpenLeaf* open(int cell, int leaf) const;
    /// Cuts a cell that is not decided; its halves become cells of their own. False if the plane does not cut it.
    bool halve(int cell, const Plane& plane);
    /// Cuts the cell and what comes of it as far as planes go. Throws TooManyCells and Cancelled.
    void subdivide(int cell);

private:
    // With more half-spaces than this in a cell it is halved along an axis first: chosen, near the
    // minimum of the triangle count over Lobb's figures.
    static constexpr std::size_t many = 14;

    // What is known of a half-space in the cell that is being looked at.
    struct Reach {
        const HalfSpace* half_space;
        Range distance, rho;
        int along;  // 1 or −1 where its normal is the plane's that is being considered, or against it; else 0
    };

    // A cell's size, and how much is open in it.
    struct Extents {
        Box box;
        int axis = 0;              // the longest, of those along which the density changes
        double size = 0;           // along it
        double radius = infinity;  // the least one that is not 0
        double width = 0;          // the greatest, across the plane of a half-space,
        Plane widest{};            // and the plane that halves it
        std::size_t half_spaces = 0;
        bool all_small = true;  // every density is there to be evaluated
    };

    struct Candidate {
        Plane plane;
        Range along;  // of the cell, along its normal
        double bias;
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
    std::size_t left_ = 0;                        // half-spaces in open cells that are done
    std::pair<int, std::size_t> visited_{-1, 0};  // a cell, and how many there were
    std::vector<Vec3> corners_;                   // of that cell
    std::vector<AlongNormal> along_normals_;      // of them, along normals that were asked for
    std::vector<Reach> reach_;                    // of its densities' half-spaces, leaf by leaf
    std::vector<Candidate> candidates_;           // planes that may cut the cell
    Vec3 turned_to_{0.0};                         // the normal of planes that are being considered
    std::vector<std::vector<Plane>> refused_;     // by cell
    int current_ = 0;
    std::vector<Range> ranges_;
    std::vector<Side> sides_;           // of open leaves
    std::vector<std::size_t> varying_;  // half-spaces of theirs that vary and are not along
};

}  // namespace deburr
