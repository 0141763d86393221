// A density on a regular grid of single-precision values, as fast as it goes without looking for what
// need not be evaluated: row by row, operator by operator, so that the compiler vectorizes. A row in
// which a half-space is certainly 0 or 1 is not evaluated for it.
#pragma once
#include <vector>

#include "bounds/density_tree.hpp"

namespace deburr::bench {

struct DensityGrid {
    Vec3 origin{0.0};
    double step = 0;
    int size[3] = {0, 0, 0};
    std::vector<float> values;  // x fastest, then y, z
};

/// Over the box, which grows to whole steps. The papers' arithmetic only; no sharp half-spaces.
DensityGrid density_grid(const DensityTree& tree, const Box& box, double step);

}  // namespace deburr::bench
