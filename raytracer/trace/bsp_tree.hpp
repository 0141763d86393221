// The BSP: axis-parallel cells, each with the local CSG of the solids whose surfaces may be in it [Lobb §3.5, after
// Jansen 1986].
//
// The root cell is all of space, so unbounded solids (a ground plane) need no special case: the outermost cells are
// infinite. Split planes are chosen by the surface-area heuristic [MacDonald & Booth 1990], where the cost of a cell is
// that of its local CSG, not the number of its solids.
#pragma once
#include <cstdint>
#include <vector>

#include "raytracer/trace/local_solid.hpp"

namespace deburr {

/// An inner node or a leaf, which is a cell.
struct BspNode {
    double split = 0;        // coordinate of the split plane along `axis`
    std::int32_t axis = 3;   // 0, 1 or 2; 3: a leaf
    std::int32_t child = 0;  // inner: node below the split, child + 1 is above it; leaf: index in cells
};

/// The range of BspTree::locals that belongs to a cell.
struct BspCell {
    std::uint32_t first = 0, count = 0;
};

/// The finished tree, and the local solids of its cells.
struct BspTree {
    Tolerances tolerances;       // that the cells were built for
    std::vector<BspNode> nodes;  // the root first
    std::vector<BspCell> cells;
    std::vector<LocalSolid> locals;  // cell by cell
    std::vector<LocalSolid> planes;  // solids that are a single half-space, kept out of the cells
    std::vector<Box> boxes;          // around each solid's surface, by the solid's number; for solids in cells
    std::size_t half_spaces = 0;     // sum over all solids
    int depth = 0;                   // of the deepest leaf; the root has depth 0
};

/// How many rays a BSP is expected to serve. For few rays, a solid that packets intersect as one product of half-spaces
/// stays a single cell: splitting it takes as long as tracing a thousand of its rays.
enum class ExpectedRays { few, many };

/// The BSP of the solids, which are numbered by their index. Its tolerances' scale is at least `min_scale`, for use
/// where rays come with larger coordinates than the solids have. Throws TooEntangled if a leaf's diagram is too large.
BspTree build_bsp(const std::vector<Solid>& solids, RootMethod root_method = RootMethod::where_needed,
                  double min_scale = 0, ExpectedRays rays = ExpectedRays::many);

}  // namespace deburr
