// A function of two variables as a surface in space, for pictures of 2-D densities.
#pragma once
#include <functional>

#include "figures/plot.hpp"
#include "polygonizer/mesh/mesh.hpp"

namespace deburr {

/// The graph of f over the rectangle, standing on the plane y = 0 with straight sides: x and z are
/// the function's variables (z towards smaller second ones), y its value, 0 to 1, times `height`.
/// A jump within a cell stays sharp. Material 0 above, 1 on the sides.
Mesh height_field(const std::function<double(Vec2)>& f, Vec2 lo, Vec2 hi, int columns, int rows, double height);

}  // namespace deburr
