// The directional albedo of a GGX boundary: the share of light that it returns by one reflection, by the direction from
// which it is seen.
//
// Multiple scattering between facets is left out, as in Smith's model; the materials of the path integrator return what
// is missing from 1 (scattering.hpp). Tables are computed at start-up by a rule without random numbers, so that they
// are the same everywhere.
#pragma once
#include <array>

namespace deburr {

/// The albedo of one boundary, tabulated by the cosine.
class AlbedoTable {
public:
    /// What the boundary does with light.
    enum class Kind {
        white,     // reflects all light
        boundary,  // reflects by Fresnel's equations, the rest is lost
        both,      // reflects by Fresnel's equations and transmits the rest; both count
    };
    /// `ior` is the index of the far side over that of the near side. An α below smooth_alpha counts as smooth.
    AlbedoTable(Kind kind, double alpha, double ior);

    /// The albedo for light at this cosine to the normal, to within 5·10⁻⁴.
    double at(double cosine) const;
    /// The mean albedo over a hemisphere, weighted by the cosine: 2 ∫ at(c) c dc, exact for the interpolated table.
    double mean() const { return mean_; }
    /// 1 / (π (1 − mean())), the normalization of a base below the boundary, if the mean is below 1.
    double base_share() const { return base_share_; }

private:
    double integral(Kind kind, double alpha, double ior, double cosine) const;
    static constexpr int steps = 64;
    std::array<double, steps + 1> albedo_{};  // at cosine (i / steps)²
    double mean_ = 0.0, base_share_ = 0.0;
};

}  // namespace deburr
