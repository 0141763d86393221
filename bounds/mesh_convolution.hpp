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
//
// A mesh is a field whose f is share − ½. Where one plane reaches a box it is a half-space there, and where two meet
// in one line a wedge: Field::as_density.
#pragma once
#include <span>

#include "bounds/closed_mesh.hpp"
#include "bounds/field.hpp"

namespace deburr {

/// The share of the ball of radius r > 0 around x that is inside the mesh, in [0, 1], and its gradient.
/// `triangles` are those that reach the ball, or more; where there are none, the share is whether x is inside.
/// Linear in their number. Off by 10⁻¹² at most, but where the sphere touches a plane within 10⁻⁶ r: 10⁻⁹ there.
ValueGradient ball_share(const ClosedMesh& mesh, std::span<const int> triangles, Vec3 x, double r);
/// The same with all triangles.
ValueGradient ball_share(const ClosedMesh& mesh, Vec3 x, double r);

/// The set share > ½. A radius of 0 stands for one that no picture and no mesh tells from it: 2⁻²⁶ of the mesh's size;
/// faces and edges are exact.
class MeshField final : public Field {
public:
    MeshField(ClosedMeshPtr mesh, double radius);

    const ClosedMesh& mesh() const { return *mesh_; }
    /// How many triangles may matter here.
    std::size_t triangle_count() const { return whole_ ? mesh_->size() : triangles_.size(); }

    ValueGradient at(Vec3 x) const override;
    Range range(const Box& box) const override;
    Range rate_range(const Box& box, Vec3 direction) const override;
    Box bounding_box() const override { return box_; }
    FieldPtr prune(const Box& box) const override;
    std::optional<DensityTree> as_density(const Box& box) const override;
    bool is_density() const override { return true; }
    double filter_radius() const override { return sharp_ ? 0 : radius_; }
    std::shared_ptr<const ClosedMesh> sharp_mesh() const override { return sharp_ && whole_ ? mesh_ : nullptr; }
    std::vector<HalfSpace> planes() const override;
    int size() const override;
    LocalSize local_size(const Box& box) const override;
    double last_sign_change_bound(Vec3 origin, Vec3 direction) const override;
    void begin_ray(FieldRay& ray) const override;
    ValueSlope at(const FieldRay& ray, double t) const override;
    RayBounds bounds(const FieldRay& ray, double t0, double t1) const override;

private:
    struct Part {};  // of another
    MeshField(Part, const MeshField& of, std::vector<int> triangles);
    std::span<const int> near(const Box& box, std::vector<int>& memory) const;
    bool is_inside(Vec3 x) const;
    Range range(const Box& box, std::span<const int> triangles) const;

    ClosedMeshPtr mesh_;
    double radius_;
    bool sharp_;
    bool whole_ = true;           // all triangles; else
    std::vector<int> triangles_;  // those that reach a box
    Box box_;
};

}  // namespace deburr
