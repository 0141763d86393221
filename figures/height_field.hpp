// Graphs of functions of two variables as surfaces in space, for pictures of 2-D densities.
#pragma once
#include <functional>

#include "figures/plot.hpp"
#include "polygonizer/mesh/mesh.hpp"

namespace deburr {

/// The graph of f over the rectangle [lo, hi], as a solid on the plane y = 0 with vertical sides. x and −z are the
/// function's variables, y is its value (0 … 1) times `height`. A jump within a cell of the grid stays sharp. Material
/// 0 is on top, 1 on the sides.
Mesh height_field(const std::function<double(Vec2)>& f, Vec2 lo, Vec2 hi, int columns, int rows, double height);

}  // namespace deburr
