// The true convolution of a closed mesh with a ball [Lobb eq. 1]: the share of a ball that lies inside, in closed form
// [docs/design.md, Closed meshes].
//
// By the divergence theorem, with the ball's centre as the origin, the part of the solid in the ball has the volume
//
//     V = ⅓ Σ h |D| + ⅓ r³ Ω       over the triangles; h: signed distance of the plane, D: part of it in the ball
//
// where Ω, the solid angle of what the sphere's surface holds of the solid, follows from its border by Gauss and
// Bonnet: arcs of circles, and the angles in which they meet. Nothing here is singular where the centre lies on a face,
// an edge or a vertex. What that leaves open is a multiple of the whole ball.
#pragma once
#include <span>

#include "bounds/box_range.hpp"
#include "bounds/closed_mesh.hpp"

namespace deburr {

/// The share of the ball of radius r > 0 around x that is inside the mesh, in [0, 1], and its gradient.
/// `triangles` are those that reach the ball, or more; where there are none, the share is whether x is inside. Where
/// the sphere cuts an edge of which one triangle is not among them, all that reach the ball are looked for. Linear in
/// their number. Off by 10⁻¹² at most, but where the sphere touches a plane within 10⁻⁶ r: 10⁻⁹ there.
ValueGradient ball_share(const ClosedMesh& mesh, std::span<const int> triangles, Vec3 x, double r);
/// The share and its gradient, with all triangles of the mesh.
ValueGradient ball_share(const ClosedMesh& mesh, Vec3 x, double r);
/// A share, its gradient, and its rate of change with r, which is −3/(4πr⁴) Σ h |D|.
struct ShareRates {
    double value = 0;
    Vec3 gradient{0.0};
    double by_radius = 0;
};
ShareRates ball_share_rates(const ClosedMesh& mesh, std::span<const int> triangles, Vec3 x, double r);
/// The area of the triangle's part that lies in the ball of radius r around x; 0 where r ≤ 0.
double area_in_ball(const ClosedMesh& mesh, int triangle, Vec3 x, double r);

}  // namespace deburr
