// Walls of a closed mesh that are too thin for the radius it is rounded by.
#pragma once
#include <cstddef>

#include "bounds/mesh_field.hpp"

namespace deburr {

/// A wall of two parallel faces whose thickness is this many radii or less vanishes: half of a ball around its middle
/// is outside. It is the root 4 sin 10° of a³ − 3a + 1 for half of it.
constexpr double vanishing_thickness = 0.69459271066772139;

struct ThinWalls {
    std::size_t facets = 0;       // with a wall behind them that vanishes
    double thickness = infinity;  // least of such a wall
    Vec3 place{0.0};              // on a facet where it is that thin
};

/// Looks inward from a few points of each facet: a face that looks the other way nearby, and a share below ½ half-way,
/// are a wall that vanishes. Walls that are thin between these points only are not found. Of a mesh with more than
/// `most` facets some are looked at, evenly.
ThinWalls thin_walls(const MeshField& field, std::size_t most = 200'000);

}  // namespace deburr
