// Plane curves for drawings: level lines of functions, and the share of a disc that a polygon covers.
#pragma once
#include <functional>
#include <vector>

#include "figures/plot.hpp"

namespace deburr {

/// The cross product a × b: positive if b is counter-clockwise of a.
inline double cross(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }

/// The lines f = level in the rectangle [lo, hi], found by a grid of columns × rows cells; their points are exact roots
/// on the grid's lines. Closed lines repeat their first point at the end.
std::vector<std::vector<Vec2>> level_lines(const std::function<double(Vec2)>& f, double level, Vec2 lo, Vec2 hi,
                                           int columns, int rows);

/// The share (0 … 1) of the disc's area inside a simple, counter-clockwise polygon, which is the polygon's true
/// convolution with the disc. Exact up to rounding.
double disc_share(const std::vector<Vec2>& polygon, Vec2 center, double radius);

/// The function sampled over the rectangle [lo, hi] as a field for Plot.
PlotField sampled(const std::function<double(Vec2)>& f, Vec2 lo, Vec2 hi, int columns, int rows);

}  // namespace deburr
