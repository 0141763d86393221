// A density with round parts, as a field: ρ − ½ [docs/design.md, Round primitives].
//
// Bounds that are made of planes know nothing of round parts, so such a density is a field of its own. Where only
// half-spaces are left of it, it is a density of half-spaces again (as_density); where one round part is left, its
// surface is a sphere, cylinder, cone or torus.
#pragma once
#include <optional>

#include "bounds/field.hpp"
#include "bounds/local_density.hpp"

namespace deburr {

/// Holds normal_at(x)·direction over the finite box, with a unit direction.
Range cosine_range(const HalfSpace& h, const Box& box, Vec3 direction);

class RoundDensity final : public Field {
public:
    /// Sharp parts of a density that is rounded elsewhere get a radius that no picture tells from 0.
    explicit RoundDensity(DensityTree tree);

    const DensityTree& tree() const { return tree_; }
    /// Whether some of its parts are sharp, and others rounded.
    bool has_sharp() const;
    /// The tree, with radius 0 where a sharp part got another.
    DensityTree as_written() const;
    /// The pruned density, made ready for evaluation; null where it has too many parts.
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
    struct Part {};  // of another
    RoundDensity(Part, DensityTree tree, const Box& seen, const RoundDensity& of);
    void add_planes(const HalfSpace& part, std::vector<HalfSpace>& to) const;
    void make_ready();
    // In a density of which a part is rounded.
    bool is_sharp(const HalfSpace& h) const { return h.radius < radius_; }

    DensityTree tree_;
    std::optional<LocalDensity> local_;
    double radius_ = 0;
    Box box_;
    Box seen_ = Box::everything();  // what it was pruned to
};

}  // namespace deburr
