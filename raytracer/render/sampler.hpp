// Where the samples of a pixel fall: points of the unit square, and the reconstruction filter.
//
// The points of a pixel are Sobol's first two dimensions, scrambled by hashing as Owen's [Laine & Karras, Stratified
// Sampling for Stochastic Transparency, 2011; Burley, Practical Hash-based Owen Scrambling, 2020]. Every dimension of
// the integral (the lens, each light, each bounce) has scrambles and an order of its own, so that the points of
// different dimensions are independent, and those of one dimension stay stratified over a pixel's samples.
//
// Pixels side by side complement one another: what one of them lacks, the next has, so that noise is fine-grained
// (blue) and the eye averages it away. [Ahmed & Wonka, Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error
// via Hierarchical Ordering of Pixels, 2020] deal the points of one sequence out to pixels in Morton's order, which
// needs the number of samples beforehand. Here any power of two will do. Take Sobol's points as functions on the
// projective line over two elements: sample i is the polynomial whose coefficients are the bits of i; x has for digits
// the coefficients of its expansion at 0, y those at 1. A pixel adds a sum of fractions bits/qʲ, q = z² + z + 1, whose
// bits are those of its place in a block, j the level. 2ᵏ samples of the 4ᵐ pixels of a square are then the functions
// N/qᵐ with N of degree below k + 2m; one of them whose first a digits of x and b digits of y are 0, a + b = k + 2m,
// has an N that zᵃ(z + 1)ᵇ divides: N = 0. So each box 2⁻ᵃ × 2⁻ᵇ holds one of these points, for all k and m. Scrambles
// that a whole block shares keep that.
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
    ///
    /// So does each of the 2ᵐ⁺²ˡ boxes 2⁻ᵏ × 2ᵏ⁻ᵐ⁻²ˡ for the first 2ᵐ samples of the 2ˡ × 2ˡ pixels whose x >> l and y
    /// >> l are the same, l ≤ block_levels.
    Vec2 square(std::uint32_t dimension) const { return square(dimension, 0, 1); }
    /// One of `parts` points per sample; all of them together are stratified like samples.
    Vec2 square(std::uint32_t dimension, int part, int parts) const;
    /// The same point's x, in less time.
    double line(std::uint32_t dimension) const;

    /// Pixels complement one another in blocks of 2^block_levels along each side.
    static constexpr int block_levels = 4;

private:
    struct Point {
        std::uint64_t key;    // of the block and the dimension
        std::uint32_t index;  // of the sample, in the pixel's order
        std::uint32_t place;  // of the pixel, in the dimension's order
    };
    Point point(std::uint32_t dimension, std::uint32_t index) const;

    std::uint64_t block_, pixel_;  // keys
    std::uint32_t place_ = 0;      // Morton's number in the block, the coarsest level in the lowest two bits
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
