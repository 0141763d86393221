// Products of half-spaces, and one minus such a product: what nearly every rounded edge and corner is
// in its cell. A ray's crossings with their surface need no search.
//
// Lobb's profile F is log-concave: on (−1, 1)
//
//     (log F)″ = −2/(1 − α)² − 1/(2 + α)² < 0,
//
// it is 1 with slope 0 up to α = −1, and 0 from α = 1 on. So along any ray log of a product P of such
// densities is concave: P > ½ on one stretch C at most, and Newton's method on log P, started
// outside of C, never steps over C's end; where log P falls already, there is nothing ahead. As 1 − F(α)
// = F(−α), complements of half-spaces are factors like any other. A sharp half-space is a factor
// that is 0 or 1. The argument needs no bound M, L or G, and holds for any number of factors.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "bounds/local_density.hpp"

namespace deburr {

/// α(x) = slope·x + base; of a sharp half-space, the distance from its plane.
struct AlphaPlane {
    Vec3 slope;
    double base;
};
AlphaPlane alpha_plane(const HalfSpace& h, bool flipped);

struct ConvexDensity {
    std::vector<AlphaPlane> planes;  // the factors of P; the sharp ones last
    int sharp = 0;                   // how many these are
    bool complement = false;         // ρ = 1 − P instead of P
};

/// The density in that form, if it has it. `scale`: coordinates reach so far; planes that differ by
/// no more than its rounding are one.
std::optional<ConvexDensity> convex_density(const LocalDensity& density, double scale);

/// A ConvexDensity whose planes lie elsewhere.
struct ConvexView {
    const AlphaPlane* planes;
    int soft, sharp;
    bool complement;

    static ConvexView of(const ConvexDensity& d) {
        return {d.planes.data(), int(d.planes.size()) - d.sharp, d.sharp, d.complement};
    }
};

/// More factors than this are not promised to be handled: convex_density() gives none.
constexpr int max_factors = 255;

/// Steps shrink quadratically, or by half where the ray touches C: then to the root of ε.
constexpr int max_newton_steps = 100;

struct ConvexCrossing {
    double t = infinity;
    bool entering = false;  // ρ > ½ beyond it
    int plane = -1;         // the factor that is crossed alone: sharp, or all others are 1; −1: none
};

/// First crossing of ρ = ½ in [t0, t1] (not infinite), to within `t_tolerance`.
ConvexCrossing first_crossing(const ConvexView& density, const Vec3& origin, const Vec3& direction, double t0,
                              double t1, double t_tolerance, std::uint64_t& evaluations);

/// Whether there is a crossing in [t0, t1].
bool any_crossing(const ConvexView& density, const Vec3& origin, const Vec3& direction, double t0, double t1,
                  double t_tolerance, std::uint64_t& evaluations);

struct ConvexCrossings {
    bool start_inside = false;  // ρ > ½ at t0
    int count = 0;
    ConvexCrossing at[2];
};

/// All crossings in [t0, t1], in order.
ConvexCrossings all_crossings(const ConvexView& density, const Vec3& origin, const Vec3& direction, double t0,
                              double t1, double t_tolerance, std::uint64_t& evaluations);

/// Unit normal of the surface at x, either way round; 0 where ρ is flat.
Vec3 surface_normal(const ConvexView& density, const ConvexCrossing& crossing, const Vec3& x);

}  // namespace deburr
