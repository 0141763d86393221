// From triangles as a file has them to the boundary of a solid: vertices joined, doubles dropped, shells turned
// outward, and refused with a place where that is not sound.
#pragma once
#include <stdexcept>
#include <string>
#include <vector>

#include "bounds/closed_mesh.hpp"
#include "raytracer/model/model_module.hpp"

namespace deburr {

/// A surface that bounds no solid, and cannot be mended soundly: counts, a place, and a word on what to do.
struct UnsoundSurface : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct ClosedSurface {
    ClosedMeshPtr mesh;
    std::vector<std::string> mended;  // what was done, if anything, each as in "turned 12 facets outward"
};

/// Corners that are equal are one vertex; where that leaves the surface open, corners within 10⁻⁵ of its size are.
/// Equal triangles count once. Shells that face inward are turned, those within others are cavities, or are dropped
/// where the solid is around them already. What overlaps is united. Throws UnsoundSurface where the surface is open or
/// empty, or crosses itself so that what it bounds is not known.
ClosedSurface closed_surface(const TriangleSoup& soup);

}  // namespace deburr
