// Many placements of one block, and rays through them.
#pragma once
#include <vector>

#include "bounds/solid.hpp"
#include "raytracer/trace/ray_tracer.hpp"

namespace deburr::bench {

/// Tilted rounded blocks, placements of one, on a cubic grid.
std::vector<Solid> blocks(int count);

/// As many rounded blocks, no two of one size, on such a grid.
std::vector<Solid> different_blocks(int count);

/// From all sides to everywhere in a cube of this side: points of two Kronecker sequences, the same in every run.
std::vector<Ray> rays_through(double side, int count);

}  // namespace deburr::bench
