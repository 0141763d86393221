// Share of light that a GGX boundary returns at once, by the direction from which it is seen.
//
// Scattering between facets more than once is left out, as Smith's model leaves it; what is missing from 1 is what
// the path integrator's materials give back (scattering.hpp). A table is made at start-up, by a rule without random
// numbers, so that it is the same everywhere.
#pragma once
#include <array>

namespace deburr {

class AlbedoTable {
public:
    enum class Kind {
        white,     // reflects all
        boundary,  // reflects by Fresnel's equations
        both,      // reflects by them, and lets the rest pass
    };
    /// `ior`: of the far side over that of the near one. An α below smooth_alpha is smooth.
    AlbedoTable(Kind kind, double alpha, double ior);

    /// The albedo for light at this cosine to the normal, to within 5·10⁻⁴.
    double at(double cosine) const;
    /// The mean over a hemisphere, weighted by the cosine: 2 ∫ at(c) c dc, of the table as it interpolates.
    double mean() const { return mean_; }
    /// 1 / (π (1 − mean())), where the mean is below 1.
    double base_share() const { return base_share_; }

private:
    double integral(Kind kind, double alpha, double ior, double cosine) const;
    static constexpr int steps = 64;
    std::array<double, steps + 1> albedo_{};  // at cosine (i / steps)²
    double mean_ = 0.0, base_share_ = 0.0;
};

}  // namespace deburr
