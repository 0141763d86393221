// The true convolution of a closed mesh with a ball [Lobb eq. 1]: the fraction of a ball's volume that is inside the
// mesh, in closed form [docs/design.md, Closed meshes].
//
// By the divergence theorem, with the ball's centre as the origin, the part of the solid in the ball has the volume
//
//     V = ⅓ Σ h |D| + ⅓ r³ Ω       over the triangles; h: signed distance of the plane, D: its part in the ball
//
// where Ω is the solid angle of the part of the sphere that is inside the solid. It follows from that part's boundary
// by the Gauss–Bonnet theorem: from arcs of circles and the angles at which they meet. Nothing here is singular where
// the centre lies on a face, an edge or a vertex. The theorem leaves a multiple of the whole ball undetermined.
#pragma once
#include <span>
#include <vector>

#include "bounds/box_range.hpp"
#include "bounds/closed_mesh.hpp"

namespace deburr {

/// RootFinder::rounding times this bounds the rounding error of a share, which is a sum over triangles.
constexpr double share_noise_scale = 64;

/// The fraction ("share") of the ball of radius r > 0 around x that is inside the mesh, in [0, 1], and its gradient by
/// x. `triangles` should hold all that reach the ball, and may hold more. If the sphere cuts an edge of which one
/// triangle is missing, all triangles that reach the ball are searched for; if none reaches it, the share is 1 or 0 by
/// whether x is inside. Time is linear in the number of triangles. The error is at most 10⁻¹², or 10⁻⁹ where the sphere
/// touches a plane within 10⁻⁶ r.
ValueGradient ball_share(const ClosedMesh& mesh, std::span<const int> triangles, Vec3 x, double r);
/// The share and its gradient as above; the triangles that reach the ball are searched for in the mesh.
ValueGradient ball_share(const ClosedMesh& mesh, Vec3 x, double r);
/// The share, its gradient by x, and its derivative by r, which is −3/(4πr⁴) Σ h |D|.
struct ShareRates {
    double value = 0;
    Vec3 gradient{0.0};
    double by_radius = 0;
};
ShareRates ball_share_rates(const ClosedMesh& mesh, std::span<const int> triangles, Vec3 x, double r);

/// The areas of the parts of a face in two balls around one point. A face is made of all connected triangles in one
/// plane.
struct FaceAreas {
    int triangle = 0;  // one of the face's
    double in_least = 0, in_greatest = 0;
};
/// Sets `found` to the faces that the ball of the radius `greatest` around x meets, with the areas of the parts of the
/// given triangles in this ball and in the concentric one of the radius `least`; 0 where the radius is not positive.
void face_areas(const ClosedMesh& mesh, std::span<const int> triangles, Vec3 x, double least, double greatest,
                std::vector<FaceAreas>& found);

}  // namespace deburr
