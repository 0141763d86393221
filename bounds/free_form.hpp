// Free forms: quadrics with perturbations [Vyatkin §3.1],
//
//     F(x) = Q(x) + Σ fᵢ Rᵢ(x),   Rᵢ = Qᵢ³ where Qᵢ ≥ 0, else 0          [Vyatkin eq. 2, 3]
//
// A perturbation of factor f > 0 raises a bump where its quadric is positive, one of f < 0 makes a dent. As Rᵢ falls to
// 0 together with its second derivative, F stays smooth. Where Qᵢ ≤ 0 throughout a box or segment the perturbation is
// pruned, so a form of many perturbations costs only those that are near.
//
// Along a ray each Q is a quadratic polynomial, so F is piecewise a polynomial of degree six.
#pragma once
#include <vector>

#include "bounds/field.hpp"
#include "bounds/quadric.hpp"

namespace deburr {

/// A term f·max(0, Q)³ of a free form.
struct Perturbation {
    double factor = 0;  // f
    Quadric quadric;
    Box support = quadric.bounding_box();  // holds Q > 0: the term is 0 outside of it
};

/// The set F > 0.
class FreeForm final : public Field {
public:
    /// Scales F and every quadric by powers of two so that their largest coefficients are near 1; the set stays the
    /// same.
    FreeForm(const Quadric& base, std::vector<Perturbation> perturbations);

    const Quadric& base() const { return base_; }
    const std::vector<Perturbation>& perturbations() const { return perturbations_; }

    ValueGradient at(Vec3 x) const override;
    Range range(const Box& box) const override;
    Box bounding_box() const override { return box_; }
    Box extent() const override;
    FieldPtr prune(const Box& box) const override;
    int size() const override;
    LocalSize local_size(const Box& box) const override;
    FieldPtr transformed_by(const Affine& map) const override;
    double last_sign_change_bound(Vec3 origin, Vec3 direction) const override;
    void begin_ray(FieldRay& ray) const override;
    double max_noise_scale(const Box& box) const override;
    ValueSlope at(const FieldRay& ray, double t) const override;
    RayBounds bounds(const FieldRay& ray, double t0, double t1) const override;

private:
    struct Part {};  // selects the constructor of a pruned part of another form
    FreeForm(Part, const Quadric& base, std::vector<Perturbation> perturbations, const Box& box)
        : base_(base), perturbations_(std::move(perturbations)), box_(box) {}
    void find_box();

    Quadric base_;
    std::vector<Perturbation> perturbations_;
    Box box_;  // holds the set F > 0
};

}  // namespace deburr
