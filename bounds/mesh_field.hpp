// A closed mesh, rounded by true convolution, as the field f = share − ½, where the share is the fraction of a ball
// around x that is inside the mesh (mesh_convolution.hpp). Where only one plane reaches a box the field is a half-space
// there, and where two planes meet in one line it is a wedge: see as_density().
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "bounds/closed_mesh.hpp"
#include "bounds/field.hpp"

namespace deburr {

/// The set share > ½ for a ball of this radius (a world distance). A radius of 0 stands for 2⁻²⁶ of the mesh's size,
/// which no picture and no mesh distinguishes from 0; faces and edges stay exact.
class MeshField final : public Field {
public:
    MeshField(ClosedMeshPtr mesh, double radius);

    const ClosedMesh& mesh() const { return *mesh_; }
    /// The number of triangles that this field, perhaps a pruned one, looks at.
    std::size_t triangle_count() const { return whole_ ? mesh_->size() : triangles_.size(); }

    ValueGradient at(Vec3 x) const override;
    Range range(const Box& box) const override;
    Range rate_range(const Box& box, Vec3 direction) const override;
    Box bounding_box() const override { return box_; }
    FieldPtr prune(const Box& box) const override;
    std::optional<Vec3> swept_along() const override;
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
    struct Part {};  // selects the constructor of a pruned part of another field
    MeshField(Part, const MeshField& of, std::vector<int> triangles);
    Box reached(const Box& box) const;
    std::span<const int> near(const Box& box, std::vector<int>& memory) const;
    bool is_inside(Vec3 x) const;
    Range range(const Box& box, std::span<const int> triangles) const;

    struct NearPlanes;
    std::optional<NearPlanes> near_planes(const Box& box, std::vector<int>& found) const;
    HalfSpace half_space(const ClosedMesh::Plane& plane) const;
    std::optional<DensityTree> one_plane(const Box& box, const std::vector<int>& triangles,
                                         const ClosedMesh::Plane& plane) const;
    std::optional<DensityTree> wedge(const Box& box, const std::vector<int>& triangles, const NearPlanes& planes) const;
    std::optional<Op> edge_between(const Box& box, const std::vector<int>& triangles, const NearPlanes& planes) const;

    ClosedMeshPtr mesh_;
    double radius_;
    bool sharp_;
    bool whole_ = true;           // whether all triangles count
    std::vector<int> triangles_;  // if not: those that count, which are all that reach some box
    Box box_;
};

}  // namespace deburr
