// The BSP: axis-parallel cells, each with the local CSG of the solids whose surface may be in it
// [Lobb §3.5, after Jansen 1986].
//
// The root cell is all of space, so unbounded solids (a ground plane) need no special care: the
// outermost cells are infinite. Split planes are chosen by the surface-area heuristic (MacDonald &
// Booth 1990), where the cost of a cell is that of its local CSG, not the number of solids.
#pragma once
#include <cstdint>
#include <vector>

#include "raytracer/trace/local_solid.hpp"

namespace deburr {

struct BspNode {
    double split = 0;
    std::int32_t axis = 3;   // 0, 1, 2; 3: a cell
    std::int32_t child = 0;  // below the split, child + 1 above it; a cell: its number
};

struct BspCell {
    std::uint32_t first = 0, count = 0;  // of BspTree::locals
};

struct BspTree {
    Tolerances tolerances;
    std::vector<BspNode> nodes;  // the root first
    std::vector<BspCell> cells;
    std::vector<LocalSolid> locals;
    std::vector<LocalSolid> planes;  // solids that are one half-space: not in the cells
    std::vector<Box> boxes;          // around each solid's surface, for the solids in the cells
    std::size_t half_spaces = 0;     // of all solids
    int depth = 0;
};

/// How many rays a BSP is built for. For few, a solid that packets cross as one product of half-spaces stays one cell:
/// to divide it takes as long as a thousand of its rays.
enum class ExpectedRays { few, many };

/// `min_scale`: of its tolerances, where rays come with larger coordinates than the solids have.
BspTree build_bsp(const std::vector<Solid>& solids, RootMethod root_method = RootMethod::where_needed,
                  double min_scale = 0, ExpectedRays rays = ExpectedRays::many);

}  // namespace deburr
