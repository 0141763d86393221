// Where the surface's points lie in the cells of an octree: on the surface to rounding, and on both
// surfaces where two meet at a hard edge [Vyatkin §3.2, §3.4].
//
// A piece is a part of the surface that is smooth by itself: a rounded density, a free form, or one
// half-space of a sharp solid. Where all crossings of a loop are on one piece and face nearly the
// same way, the point is their mean, taken to the surface. Where they do not, it starts from where
// the tangent planes at the crossings come closest to meeting (Kobbelt et al. 2001), which is the tip
// of a cone; where the pieces differ, it goes on by Newton's method to where they are all 0.
#pragma once
#include <optional>
#include <vector>

#include "polygonizer/mesh/surface_distance.hpp"

namespace deburr {

struct Face {
    Vec3 normal{0.0};  // unit, outward
    int material = 0;
    int leaf = -1;  // by its number in the whole solid; −1: a plane
};

/// The face of a point on the surface, given what SignedDistance says there.
Face face_of(const SignedDistance& solid, const SurfaceSample& there);

struct SurfacePoint {
    Vec3 position{0.0};
    std::vector<Face> faces;  // one: smooth; more: on a hard edge or a corner
    bool hard() const { return faces.size() > 1; }
};

/// One end inside, one outside, and the surface between them.
struct CrossingPoint {
    Vec3 inside, outside, position;
};

/// The root between two points of which one is inside and the other is not.
Vec3 surface_root(const SignedDistance& solid, Vec3 inside, Vec3 outside);

/// The point of the sheet that passes `cell` in these crossings; in the cell, but for a tip that
/// sticks out of it, if that may be. Faces that bend by no more than acos(hard_cosine) are one.
SurfacePoint surface_point(const SignedDistance& solid, const Box& cell, const std::vector<CrossingPoint>& crossings,
                           double hard_cosine, bool tip_may_stick_out);

/// Point no farther than `reach` from x at which the two pieces meet that pass through both p and q;
/// none if they meet at no hard edge there.
std::optional<SurfacePoint> hard_edge_point(const SignedDistance& solid, Vec3 x, Vec3 p, Vec3 q, double reach,
                                            double hard_cosine);

/// Point at which the pieces that pass through these two or three points meet, if no piece passes through
/// all: the point of a hard edge, or corner, that their mesh cuts off. It is no farther from x than they are apart.
std::optional<SurfacePoint> cut_off_point(const SignedDistance& solid, const std::vector<Vec3>& points, Vec3 x,
                                          double hard_cosine);

}  // namespace deburr
