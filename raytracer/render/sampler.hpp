// Where the samples of a pixel fall: points of the unit square, and the reconstruction filter.
//
// The points are Sobol's first two dimensions, scrambled and shuffled by hashing as Owen's
// [Laine & Karras, Stratified Sampling for Stochastic Transparency, 2011; Burley, Practical
// Hash-based Owen Scrambling, 2020]. Every dimension of the integral (the lens, each light, each
// bounce) has its own shuffle, so that the points of different dimensions are independent, and
// those of one dimension stay stratified over a pixel's samples.
#pragma once
#include <cstdint>

#include "bounds/vec.hpp"

namespace deburr {

/// All numbers are functions of (seed, x, y, sample, dimension) and lie in [0, 1).
class Sampler {
public:
    Sampler(std::uint64_t seed, int x, int y, int sample);

    /// Over 2ᵐ samples from a multiple of 2ᵐ on, each of the 2ᵐ equal boxes of any one shape
    /// 2⁻ᵏ × 2ᵏ⁻ᵐ holds one point.
    Vec2 square(std::uint32_t dimension) const { return square(dimension, 0, 1); }
    /// One of `parts` points per sample; all of them together are stratified like samples.
    Vec2 square(std::uint32_t dimension, int part, int parts) const;
    /// The same point's x, in half of the time.
    double line(std::uint32_t dimension) const;

private:
    std::uint64_t pixel_;
    std::uint32_t sample_;
};

/// Pixel widths from a pixel's centre to the end of its filter.
constexpr double filter_radius = 1.5;

/// The reconstruction filter along one axis: a Blackman-Harris window, positive and of unit area;
/// 0 for |x| ≥ filter_radius.
double filter_value(double x);

/// A uniform point of the square to an offset from the pixel's centre, distributed like the filter
/// [Ernst, Stamminger & Greiner, Filter Importance Sampling, 2006]: every sample weighs the same
/// and no sample is shared, so a pixel needs no neighbours.
Vec2 filter_offset(Vec2 u);

}  // namespace deburr
