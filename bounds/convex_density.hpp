// Products of half-spaces, and one minus such a product, which nearly all rounded edges and corners are in their cells.
// The crossings of a ray with their surface need no search.
//
// Lobb's profile F is log-concave: on (−1, 1)
//
//     (log F)″ = −2/(1 − α)² − 1/(2 + α)² < 0,
//
// it is 1 with slope 0 up to α = −1, and 0 from α = 1 on. So along any ray the logarithm of a product P of such
// densities is concave: P > ½ on one stretch C at most, and Newton's method on log P, started outside of C, never steps
// over C's end; where log P falls already, no crossing lies ahead. As 1 − F(α) = F(−α), complements of half-spaces are
// factors like any other. A sharp half-space is a factor that is 0 or 1. The argument needs no bound M, L or G, and
// holds for any number of factors.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "bounds/local_density.hpp"

namespace deburr {

/// An affine function α(x) = slope·x + base; for a sharp half-space it is the distance from its plane instead of α.
struct AlphaPlane {
    Vec3 slope;
    double base;
};
/// α of the half-space, which is no round part; with `flipped`, that of its complement.
AlphaPlane alpha_plane(const HalfSpace& h, bool flipped);

/// ρ = P or ρ = 1 − P, with the product P of the densities of `planes`.
struct ConvexDensity {
    std::vector<AlphaPlane> planes;  // factors of P; the sharp ones last
    int sharp = 0;                   // number of sharp factors
    bool complement = false;         // ρ = 1 − P instead of P
};

/// The density in that form, if it has it and at most max_factors factors. It has no round parts. `scale` is the
/// largest coordinate in the scene (a world length): planes that differ by no more than its rounding count as one.
std::optional<ConvexDensity> convex_density(const LocalDensity& density, double scale);

/// A ConvexDensity whose planes are owned by someone else: `soft` rounded factors, then `sharp` sharp ones.
struct ConvexView {
    const AlphaPlane* planes;
    int soft, sharp;
    bool complement;

    static ConvexView of(const ConvexDensity& d) {
        return {d.planes.data(), int(d.planes.size()) - d.sharp, d.sharp, d.complement};
    }
};

/// The largest number of factors of a ConvexDensity.
constexpr int max_factors = 255;

/// Limit of Newton steps. Steps shrink quadratically, or by half where the ray touches C, and then down to √ε.
constexpr int max_newton_steps = 100;

/// A crossing of ρ = ½ at ray parameter t; t = infinity: there is none.
struct ConvexCrossing {
    double t = infinity;
    bool entering = false;  // ρ > ½ beyond t
    int plane = -1;  // index of the factor that alone makes the crossing, as it is sharp or all others are 1; −1: none
};

/// The first crossing of ρ = ½ in [t0, t1], to within `t_tolerance` in t; t0 is finite, t1
/// need not be. `evaluations` is counted up.
ConvexCrossing first_crossing(const ConvexView& density, const Vec3& origin, const Vec3& direction, double t0,
                              double t1, double t_tolerance, std::uint64_t& evaluations);

/// Whether there is a crossing in [t0, t1]; t0 is finite.
bool any_crossing(const ConvexView& density, const Vec3& origin, const Vec3& direction, double t0, double t1,
                  double t_tolerance, std::uint64_t& evaluations);

/// The crossings on a segment: no more than two, as C is one stretch.
struct ConvexCrossings {
    bool start_inside = false;  // ρ > ½ at t0
    int count = 0;
    ConvexCrossing at[2];
};

/// All crossings in [t0, t1], in order of t; t0 is finite.
ConvexCrossings all_crossings(const ConvexView& density, const Vec3& origin, const Vec3& direction, double t0,
                              double t1, double t_tolerance, std::uint64_t& evaluations);

/// Unit normal of the surface at x, pointing inward or outward; 0 where ρ has no gradient.
Vec3 surface_normal(const ConvexView& density, const ConvexCrossing& crossing, const Vec3& x);

}  // namespace deburr
