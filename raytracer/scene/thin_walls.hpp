// Finds walls of a closed mesh that are too thin for its rounding radius.
#pragma once
#include <cstddef>

#include "bounds/mesh_field.hpp"

namespace deburr {

/// A wall between two parallel faces vanishes if its thickness is at most this many radii: then half of a ball around
/// its middle is outside. Half of it, 2 sin 10°, is the root of u³ − 3u + 1.
constexpr double vanishing_thickness = 0.69459271066772139;

/// The walls that vanish.
struct ThinWalls {
    std::size_t facets = 0;       // number of facets in front of such a wall
    double thickness = infinity;  // the least one
    Vec3 place{0.0};              // on a facet where the wall is that thin
};

/// Looks inward from a few points of each facet: a face nearby that looks the opposite way, and a share below ½
/// half-way to it, mean a wall that vanishes. Walls that are thin only between these points are not found. Of a mesh
/// with more than `most` facets, evenly spaced ones are examined.
ThinWalls thin_walls(const MeshField& field, std::size_t most = 200'000);

}  // namespace deburr
