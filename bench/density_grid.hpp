// Samples a density on a regular grid in single precision, as fast as possible without a hierarchy: row by row and
// operator by operator, so that the compiler vectorizes. A half-space that is certainly 0 or 1 in a whole row is not
// evaluated there.
#pragma once
#include <vector>

#include "bounds/density_tree.hpp"

namespace deburr::bench {

/// A grid of samples.
struct DensityGrid {
    Vec3 origin{0.0};
    double step = 0;
    int size[3] = {0, 0, 0};
    std::vector<float> values;  // x fastest, then y, then z
};

/// Samples over the box, enlarged to whole steps. Only the papers' arithmetic without sharp half-spaces is supported.
DensityGrid density_grid(const DensityTree& tree, const Box& box, double step);

}  // namespace deburr::bench
