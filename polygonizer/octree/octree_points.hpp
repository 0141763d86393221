// Places the surface points in the cells of an octree: on the surface up to rounding, and on both surfaces where two
// meet at a hard edge [Vyatkin §3.2, §3.4].
//
// A piece is a part of the surface that is smooth by itself: that of a rounded density, of a free form, or of one
// half-space of a sharp solid. If all crossings of a loop are on one piece and face nearly the same way, the point is
// their mean, moved to the surface. Otherwise it starts where the tangent planes at the crossings come closest to
// meeting (Kobbelt et al. 2001), which is the tip of a cone; if the pieces differ, it goes on by Newton's method to
// where all of them are 0.
#pragma once
#include <optional>
#include <vector>

#include "polygonizer/mesh/surface_distance.hpp"

namespace deburr {

/// A face of the solid at a point.
struct Face {
    Vec3 normal{0.0};  // unit, outward
    int material = 0;
    int leaf = -1;  // number of the leaf in the whole solid; −1: a plane
};

/// The face of a point on the surface, given the solid's sample there. SignedDistance::line() must be the leaf's
/// number.
Face face_of(const SignedDistance& solid, const SurfaceSample& there);

/// A point of the mesh, and the faces that meet in it.
struct SurfacePoint {
    Vec3 position{0.0};
    std::vector<Face> faces;  // one: smooth; more: on a hard edge or at a corner
    bool hard() const { return faces.size() > 1; }
};

/// A crossing: one end of the edge inside, one outside, and the surface between them.
struct CrossingPoint {
    Vec3 inside, outside, position;
};

/// A point of the surface between two points, of which one is inside and the other is not.
Vec3 surface_root(const SignedDistance& solid, Vec3 inside, Vec3 outside);

/// The point of the sheet that passes the cell in these crossings. It lies in the cell, except for a cone's tip if
/// `tip_may_stick_out`. Faces at an angle of at most acos(hard_cosine) count as one.
SurfacePoint surface_point(const SignedDistance& solid, const Box& cell, const std::vector<CrossingPoint>& crossings,
                           double hard_cosine, bool tip_may_stick_out);

/// The point, at most `reach` from x, where the two pieces meet that pass through both p and q; none if they meet at no
/// hard edge there.
std::optional<SurfacePoint> hard_edge_point(const SignedDistance& solid, Vec3 x, Vec3 p, Vec3 q, double reach,
                                            double hard_cosine);

/// The point where the pieces through these two or three points meet, if no piece passes through all of them: the point
/// of a hard edge, or the corner, that the mesh cuts off. It is no farther from x than the points are apart.
std::optional<SurfacePoint> cut_off_point(const SignedDistance& solid, const std::vector<Vec3>& points, Vec3 x,
                                          double hard_cosine);

}  // namespace deburr
