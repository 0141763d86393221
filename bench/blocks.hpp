// Scenes of many blocks, and rays through them.
#pragma once
#include <vector>

#include "bounds/solid.hpp"
#include "raytracer/trace/ray_tracer.hpp"

namespace deburr::bench {

/// Placements of one tilted rounded block on a cubic grid.
std::vector<Solid> blocks(int count);

/// Rounded blocks on such a grid, all of different sizes.
std::vector<Solid> different_blocks(int count);

/// Rays from all sides to all places in a cube with this side, by two Kronecker sequences: the same in every run.
std::vector<Ray> rays_through(double side, int count);

}  // namespace deburr::bench
