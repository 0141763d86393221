// Local densities with round parts whose crossings with a ray need no general search: a single round part, whose
// surface is intersected in closed form, or a product of planes, convex round parts and cones together with their
// mirrored sides, whose logarithm is concave along every ray. Products without such cones are ProductSums, too
// (product_sum.hpp) [docs/design.md, Round primitives].
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "bounds/convex_density.hpp"
#include "bounds/round_coordinate.hpp"
#include "bounds/torus_on_ray.hpp"

namespace deburr {

class Torus;

/// The surface u = offset of a sphere, cylinder, cone or torus. The solid is where u is less, or with `complement`
/// where u is greater.
struct RoundSurface {
    RoundCoordinate coordinate;
    double offset = 0;
    bool complement = false;

    /// The surface ρ = ½ of a density of a single round part. None if the density has other half-spaces, if ρ does not
    /// cross ½, or for tori that TorusOnRay does not handle.
    static std::optional<RoundSurface> of(const LocalDensity& density);
    /// The surface of a sharp torus; none for a torus that TorusOnRay does not handle.
    static std::optional<RoundSurface> of(const Torus& torus);
    bool is_torus() const { return coordinate.kind == RoundCoordinate::Kind::circle; }
    /// All crossings in [t0, t1], in order of t.
    RoundCrossings crossings(const Vec3& origin, const Vec3& direction, double t0, double t1) const;
    /// Unit normal of the surface at x, pointing out of the solid.
    Vec3 normal(const Vec3& x) const;
};

/// ρ = P or 1 − P for a product P of half-spaces and round parts.
class RoundProduct {
public:
    /// The density in that form; none if it is no product, has a sharp half-space, a torus, the outside of a round part
    /// or more than max_factors factors.
    static std::optional<RoundProduct> of(const LocalDensity& density);

    /// All crossings of ρ = ½ in [t0, t1], in order, to within `t_tolerance` in t. `evaluations` is counted up.
    ConvexCrossings crossings(const Vec3& origin, const Vec3& direction, double t0, double t1, double t_tolerance,
                              std::uint64_t& evaluations) const;
    /// Unit normal of the surface at x, pointing inward or outward.
    Vec3 normal(const Vec3& x) const;

private:
    friend class RoundProductRay;
    std::vector<HalfSpace> factors_;
    std::shared_ptr<const std::deque<RoundCoordinate>> rounds_;  // owns what factors_ point to
    bool complement_ = false;
};

}  // namespace deburr
