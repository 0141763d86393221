// Decides whether a triangle of a mesh faces outward.
#pragma once
#include "polygonizer/mesh/surface_distance.hpp"

namespace deburr {

/// Whether a triangle with this unit normal and its middle at x faces outward. It does if the solid's surface nearest
/// to x faces as it does. Otherwise, as the nearest surface says little near edges, the line through x along the normal
/// decides: by how the solid's surface faces where the line first meets it. If it meets none within `reach`, for
/// example at the overhang of a chord over a concave edge, `otherwise`, the sum of the corners' outward normals,
/// decides. `here` is the solid's sample at x.
bool faces_outward(const DistanceField& solid, Vec3 x, const SurfaceSample& here, Vec3 normal, Vec3 otherwise,
                   double reach);

}  // namespace deburr
