// A local density whose half-spaces are all parallel is a function of one coordinate, and its
// isosurface is planes. One half-space of the papers' legal densities gives its own plane h; flush
// faces of an illegal sum give the plane that they are moved out to.
#pragma once
#include <vector>

#include "bounds/local_density.hpp"
#include "polygonizer/triage/cell_complex.hpp"

namespace deburr {

/// False also where there is no half-space at all.
bool is_parallel_family(const LocalDensity& density);

/// Least and greatest n·x.
Range extent_along(Vec3 normal, const std::vector<Vec3>& points);

struct LevelPlanes {
    std::vector<Plane> planes;  // where ρ passes ½
    bool inside = false;        // if there is none: which side all is on
};

/// Level planes of a parallel family with s.lo < n·x < s.hi, where n is its first half-space's
/// normal. Those within `tolerance` of an end are none.
LevelPlanes level_planes(const LocalDensity& density, Range s, double tolerance);

/// Whether all normals lie in a plane but are not parallel: then the surface is swept along
/// `direction`.
bool is_swept(const LocalDensity& density, Vec3& direction);

}  // namespace deburr
