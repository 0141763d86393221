// A density with round parts as a field, f = ρ − ½ [docs/design.md, Round primitives].
//
// Bound CSG is made of planes and knows nothing of round parts, so such a density is a field of its own. Where only
// half-spaces are left of it, it becomes a density of half-spaces again (as_density()); where one round part is left,
// its surface is a sphere, cylinder, cone or torus.
#pragma once
#include <optional>

#include "bounds/field.hpp"
#include "bounds/local_density.hpp"

namespace deburr {

/// A range that holds normal_at(x)·direction over the finite box; `direction` is a unit vector.
Range cosine_range(const HalfSpace& h, const Box& box, Vec3 direction);

/// The field of a DensityTree with round parts.
class RoundDensity final : public Field {
public:
    /// Sharp parts get a radius too small to be seen in any picture or mesh, because f must be smooth.
    explicit RoundDensity(DensityTree tree);

    /// The tree, with that radius for sharp parts.
    const DensityTree& tree() const { return tree_; }
    /// Whether some parts are sharp while others are rounded.
    bool has_sharp() const;
    /// The tree with the radius 0 for parts that were sharp.
    DensityTree as_written() const;
    /// The density prepared for evaluation; null if it has more than 24 half-spaces or its diagrams would be too large.
    const LocalDensity* local() const { return local_ ? &*local_ : nullptr; }

    ValueGradient at(Vec3 x) const override;
    Range range(const Box& box) const override;
    Range rate_range(const Box& box, Vec3 direction) const override;
    Box bounding_box() const override { return box_; }
    Box extent() const override;
    FieldPtr prune(const Box& box) const override;
    std::optional<DensityTree> as_density(const Box& box) const override;
    bool is_density() const override { return true; }
    double filter_radius() const override { return radius_; }
    std::vector<HalfSpace> planes() const override;
    int size() const override { return int(tree_.half_spaces.size()); }
    LocalSize local_size(const Box& box) const override;
    FieldPtr transformed_by(const Affine& map) const override;
    double last_sign_change_bound(Vec3 origin, Vec3 direction) const override;
    void begin_ray(FieldRay& ray) const override;
    ValueSlope at(const FieldRay& ray, double t) const override;
    RayBounds bounds(const FieldRay& ray, double t0, double t1) const override;

private:
    struct Part {};  // selects the constructor of a pruned part of another field
    RoundDensity(Part, DensityTree tree, const Box& seen, const RoundDensity& of);
    void add_planes(const HalfSpace& part, std::vector<HalfSpace>& to) const;
    void make_ready();
    // Whether the half-space is sharp in a density that also has rounded ones.
    bool is_sharp(const HalfSpace& h) const { return h.radius < radius_; }

    DensityTree tree_;
    std::optional<LocalDensity> local_;
    double radius_ = 0;
    Box box_;
    Box seen_ = Box::everything();  // the box to which it was pruned
};

}  // namespace deburr
