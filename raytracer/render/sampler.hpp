// Sampling points in the unit square, and the reconstruction filter.
//
// The points of a pixel are Sobol's first two dimensions with Owen scrambling by hashing [Laine & Karras, Stratified
// Sampling for Stochastic Transparency, 2011; Burley, Practical Hash-based Owen Scrambling, 2020]. Every dimension of
// the integral (the lens, each light, each bounce) has its own scrambles and order, so that the points of different
// dimensions are independent, and those of one dimension stay stratified over a pixel's samples.
//
// Neighbouring pixels complement one another: what one lacks, the next has, so that noise is fine-grained (blue) and
// the eye averages it away. [Ahmed & Wonka, Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error via
// Hierarchical Ordering of Pixels, 2020] distribute the points of one sequence to pixels in Morton order, which needs
// the number of samples in advance. Here any power of two will do. Take Sobol's points as functions on the projective
// line over the field of two elements: sample i is the polynomial whose coefficients are the bits of i; the digits of x
// are the coefficients of its expansion at 0, those of y at 1. A pixel adds a sum of fractions bits/qʲ, q = z² + z + 1,
// whose bits are those of its position in a block, j the level. Then 2ᵏ samples of the 4ᵐ pixels of a square are the
// functions N/qᵐ with N of degree below k + 2m. If the first a digits of x and b digits of y of one of them are 0, a +
// b = k + 2m, its N is divisible by zᵃ(z + 1)ᵇ, so N = 0. So each box 2⁻ᵃ × 2⁻ᵇ holds one of these points, for all k
// and m. Scrambles that are shared by a whole block preserve that.
#pragma once
#include <cstdint>

#include "bounds/vec.hpp"

namespace deburr {

/// The random numbers of one sample of one pixel: functions of (seed, x, y, sample, dimension) in [0, 1).
class Sampler {
public:
    Sampler(std::uint64_t seed, int x, int y, int sample);

    /// A point of the unit square. Over 2ᵐ samples that begin at a multiple of 2ᵐ, each of the 2ᵐ equal boxes of any
    /// one shape 2⁻ᵏ × 2ᵏ⁻ᵐ holds one point.
    ///
    /// The same holds for each of the 2ᵐ⁺²ˡ boxes 2⁻ᵏ × 2ᵏ⁻ᵐ⁻²ˡ and the first 2ᵐ samples of the 2ˡ × 2ˡ pixels that
    /// agree in x >> l and y >> l, l ≤ block_levels.
    Vec2 square(std::uint32_t dimension) const { return square(dimension, 0, 1); }
    /// Point number `part` of `parts` per sample; all of them together are stratified like samples.
    Vec2 square(std::uint32_t dimension, int part, int parts) const;
    /// The x coordinate of square(dimension), computed faster.
    double line(std::uint32_t dimension) const;

    /// Pixels complement one another in blocks with sides of 2^block_levels pixels.
    static constexpr int block_levels = 4;

private:
    // A point of one dimension before it is scrambled.
    struct Point {
        std::uint64_t key;    // of the block and the dimension
        std::uint32_t index;  // of the sample, in the pixel's order
        std::uint32_t place;  // of the pixel, in the dimension's order
    };
    Point point(std::uint32_t dimension, std::uint32_t index) const;

    std::uint64_t block_, pixel_;  // keys
    std::uint32_t place_ = 0;      // Morton code in the block, with the coarsest level in the lowest two bits
    std::uint32_t sample_;
};

/// Half the width of the reconstruction filter, in pixels.
constexpr double filter_radius = 1.5;

/// The reconstruction filter along one axis: a Blackman-Harris window, positive and of unit area; 0 for |x| ≥
/// filter_radius.
double filter_value(double x);

/// Maps a uniform point of the unit square to an offset from the pixel's center that is distributed like the filter
/// [Ernst, Stamminger & Greiner, Filter Importance Sampling, 2006]: every sample has the same weight and belongs to one
/// pixel, so a pixel needs no neighbours.
Vec2 filter_offset(Vec2 u);

}  // namespace deburr
