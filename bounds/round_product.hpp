// What is left of a density with round parts in a cell: one round part, whose surface is intersected at once, or a
// product whose logarithm is concave along every ray, of planes, convex round parts and cones with their other sides;
// without these it is a sum of products as well (product_sum.hpp) [docs/design.md, Round primitives].
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "bounds/convex_density.hpp"
#include "bounds/round_coordinate.hpp"
#include "bounds/torus_on_ray.hpp"

namespace deburr {

class Torus;

/// The surface u = offset of a sphere, cylinder, cone or torus; the solid is on the side where u is less, or on the
/// other.
struct RoundSurface {
    RoundCoordinate coordinate;
    double offset = 0;
    bool complement = false;

    /// The surface ρ = ½ of a density of one round part; none where ρ does not cross ½, or of tori that TorusOnRay is
    /// not for.
    static std::optional<RoundSurface> of(const LocalDensity& density);
    /// The surface of a sharp torus; none where TorusOnRay is not for it.
    static std::optional<RoundSurface> of(const Torus& torus);
    bool is_torus() const { return coordinate.kind == RoundCoordinate::Kind::circle; }
    RoundCrossings crossings(const Vec3& origin, const Vec3& direction, double t0, double t1) const;
    /// Out of the solid.
    Vec3 normal(const Vec3& x) const;
};

class RoundProduct {
public:
    static std::optional<RoundProduct> of(const LocalDensity& density);

    ConvexCrossings crossings(const Vec3& origin, const Vec3& direction, double t0, double t1, double t_tolerance,
                              std::uint64_t& evaluations) const;
    /// Unit normal of the surface at x, either way round.
    Vec3 normal(const Vec3& x) const;

private:
    friend class RoundProductRay;
    std::vector<HalfSpace> factors_;
    std::shared_ptr<const std::deque<RoundCoordinate>> rounds_;  // what they point to
    bool complement_ = false;
};

}  // namespace deburr
