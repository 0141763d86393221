// Local densities whose half-spaces are all parallel: they are functions of one coordinate, and their isosurfaces are
// planes. A legal density of one half-space has the plane h itself; flush faces of an illegal sum have the plane to
// which they are moved outward.
#pragma once
#include <vector>

#include "bounds/local_density.hpp"
#include "polygonizer/triage/cell_complex.hpp"

namespace deburr {

/// Whether all half-spaces are parallel; false if there are none, and for rounded meshes.
bool is_parallel_family(const LocalDensity& density);

/// Range of n·x over the points.
Range extent_along(Vec3 normal, const std::vector<Vec3>& points);

/// The result of level_planes().
struct LevelPlanes {
    std::vector<Plane> planes;  // where ρ passes ½
    bool inside = false;        // if there are no planes: whether everything is inside
};

/// The level planes of a parallel family with s.lo < n·x < s.hi, where n is the normal of its first half-space. Planes
/// within `tolerance` of an end are left out.
LevelPlanes level_planes(const LocalDensity& density, Range s, double tolerance);

/// Whether all normals are perpendicular to one direction but not all parallel: then the surface is swept along
/// `direction`, a unit vector that is set.
bool is_swept(const LocalDensity& density, Vec3& direction);

}  // namespace deburr
