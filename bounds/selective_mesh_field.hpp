// A closed mesh rounded by a radius that varies in space, so that some of its edges stay sharp [kept_edges.hpp]: f =
// share − ½, with the share of the ball of radius r(x) around x.
//
// Faces stay flat, for half of any ball around their points is inside. Where r is constant it is a MeshField, of that
// radius or none. Elsewhere, with aᵢ = |Dᵢ|/r², ηᵢ = hᵢ/r, φᵢ the arcs of triangle i, and u a unit vector,
//
//     f′ = −3/(4πr) Σ aᵢ (nᵢ·u + ηᵢ r′)
//     |f″| ≤ |share″| + 3/(4πr²) Σ (2 |nᵢ·u| |r′| |3aᵢ − φᵢ| + r′² |ηᵢ| |4aᵢ − φᵢ|) + 3/(4πr) |r″| Σ |ηᵢ| aᵢ
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "bounds/kept_edges.hpp"
#include "bounds/mesh_field.hpp"

namespace deburr {

class SelectiveMeshField final : public Field {
public:
    SelectiveMeshField(ClosedMeshPtr mesh, double radius, KeptEdges kept);

    /// The mesh rounded everywhere.
    const MeshField& full() const { return *full_; }

    ValueGradient at(Vec3 x) const override;
    Range range(const Box& box) const override;
    Range rate_range(const Box& box, Vec3 direction) const override;
    Box bounding_box() const override { return full_->bounding_box(); }
    FieldPtr prune(const Box& box) const override;
    std::optional<DensityTree> as_density(const Box& box) const override;
    double filter_radius() const override { return radius_->full(); }
    std::vector<HalfSpace> planes() const override;
    int size() const override;
    LocalSize local_size(const Box& box) const override;
    double last_sign_change_bound(Vec3 origin, Vec3 direction) const override;
    void begin_ray(FieldRay& ray) const override;
    ValueSlope at(const FieldRay& ray, double t) const override;
    RayBounds bounds(const FieldRay& ray, double t0, double t1) const override;

private:
    struct Part {};  // of another
    struct Local;
    SelectiveMeshField(Part, const SelectiveMeshField& of, const Local& local);
    /// The triangles and kept edges that reach a finite box.
    Local local(const Box& box) const;
    /// The field of constant radius that it is there; null if it is none.
    std::shared_ptr<const MeshField> constant(const LocalRadius::Bounds& bounds) const;
    Box reached(const Box& box) const;
    Range range(const Box& box, const Local& local) const;
    ValueGradient at(Vec3 x, std::span<const int> triangles, std::span<const LocalRadius::Segment> edges) const;

    ClosedMeshPtr mesh_;
    std::shared_ptr<const LocalRadius> radius_;
    std::shared_ptr<const MeshField> full_, kept_;
    double greatest_ = 0;  // radius there, of a part
    Vec3 center_{0.0};     // of its box
    bool whole_ = true;    // all triangles and edges; else those that reach a box
    std::vector<int> triangles_;
    std::vector<LocalRadius::Segment> edges_;
};

/// The mesh that a field is made of, rounded everywhere; null if it is made of none.
const MeshField* mesh_field_of(const Field* field);

}  // namespace deburr
