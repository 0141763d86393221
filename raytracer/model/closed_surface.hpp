// Turns the triangles of a file into the boundary of a solid: joins vertices, drops duplicate triangles, turns shells
// outward, and refuses, with a place, surfaces that cannot be mended soundly.
#pragma once
#include <stdexcept>
#include <string>
#include <vector>

#include "bounds/closed_mesh.hpp"
#include "raytracer/model/model_module.hpp"

namespace deburr {

/// The surface does not bound a solid and cannot be mended soundly. what() gives counts, a place, and what the user can
/// do.
struct UnsoundSurface : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A closed surface, and how it was mended.
struct ClosedSurface {
    ClosedMeshPtr mesh;
    std::vector<std::string> mended;  // repairs made, such as "turned 12 facets outward"
};

/// The boundary of a solid from the triangles of a file. Vertices at equal positions are joined, and if the surface is
/// open then, also vertices along its open edges within 10⁻⁵ of its size. Duplicate triangles count once. Shells that
/// face inward are turned; those within others are cavities, or are dropped if the solid is around them already.
/// Overlapping shells are united. Throws UnsoundSurface if the surface is open or empty, or crosses itself in a way
/// that leaves the solid undefined.
ClosedSurface closed_surface(const TriangleSoup& soup);

}  // namespace deburr
