// A closed mesh rounded by a radius r(x) that varies in space, so that some of its edges stay sharp (kept_edges.hpp):
// f = share − ½ with the share of the ball of radius r(x) around x.
//
// Faces stay flat, because half of any ball around a point of a face is inside. Where r is constant the field is a
// MeshField with that radius. Elsewhere, with aᵢ = |Dᵢ|/r², ηᵢ = hᵢ/r, the arcs φᵢ of triangle i, and a unit vector u,
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

/// The set f > 0 above.
class SelectiveMeshField final : public Field {
public:
    /// `radius` is the rounding radius away from what is kept; it falls to 2⁻¹⁰ of that.
    SelectiveMeshField(ClosedMeshPtr mesh, double radius, KeptEdges kept);

    /// The mesh rounded by the full radius everywhere.
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
    struct Part {};  // selects the constructor of a pruned part of another field
    struct Local;
    SelectiveMeshField(Part, const SelectiveMeshField& of, const Local& local);
    /// The triangles and kept edges that reach a finite box.
    Local local(const Box& box) const;
    /// The field of constant radius that this one equals where the radius has these bounds; null if the radius varies.
    std::shared_ptr<const MeshField> constant(const LocalRadius::Bounds& bounds) const;
    Box reached(const Box& box) const;
    Range range(const Box& box, const Local& local) const;
    ValueGradient at(Vec3 x, std::span<const int> triangles, std::span<const LocalRadius::Segment> edges) const;

    ClosedMeshPtr mesh_;
    std::shared_ptr<const LocalRadius> radius_;
    std::shared_ptr<const MeshField> full_, kept_;
    double greatest_ = 0;  // part only: the greatest radius in its box
    Vec3 center_{0.0};     // part only: centre of its box
    bool whole_ = true;    // whether all triangles and edges count; if not, those below do, which reach its box
    std::vector<int> triangles_;
    std::vector<LocalRadius::Segment> edges_;
};

/// The MeshField with the full radius that a field is made of: a MeshField itself, or that of a SelectiveMeshField;
/// null for other fields.
const MeshField* mesh_field_of(const Field* field);

}  // namespace deburr
