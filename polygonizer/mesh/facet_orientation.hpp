// Whether a triangle of a mesh faces outward.
#pragma once
#include "polygonizer/mesh/surface_distance.hpp"

namespace deburr {

/// Whether a triangle with this unit normal and its middle at x faces outward: as the solid's surface
/// does that is nearest to x, or, where edges are so near that this says little, as it does where it
/// is first met on the line through x along the normal. Where that meets none within `reach`, on the
/// overhang of a chord over a hollow edge say, `otherwise`, the outward normals of the corners decide.
/// `here` is the solid at x.
bool faces_outward(const DistanceField& solid, Vec3 x, const SurfaceSample& here, Vec3 normal, Vec3 otherwise,
                   double reach);

}  // namespace deburr
