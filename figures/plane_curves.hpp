// Curves in the plane for drawings: where a function has a value, and what share of a disc a polygon
// covers.
#pragma once
#include <functional>
#include <vector>

#include "figures/plot.hpp"

namespace deburr {

/// Positive if b is counter-clockwise of a.
inline double cross(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }

/// The lines f = level within the rectangle: a grid of columns × rows finds them, and their points,
/// on the grid's lines, are exact roots. Closed where they close.
std::vector<std::vector<Vec2>> level_lines(const std::function<double(Vec2)>& f, double level, Vec2 lo, Vec2 hi,
                                           int columns, int rows);

/// The share, 0 to 1, of the disc's area that lies in a simple polygon (counter-clockwise): in the
/// plane the true convolution of the polygon with a disc. Exact but for rounding.
double disc_share(const std::vector<Vec2>& polygon, Vec2 center, double radius);

/// The function over the rectangle as a field for Plot.
PlotField sampled(const std::function<double(Vec2)>& f, Vec2 lo, Vec2 hi, int columns, int rows);

}  // namespace deburr
