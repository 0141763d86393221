#include "raytracer/render/sampler.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace deburr {
namespace {

// SplitMix64's finalizer [Steele, Lea & Flood 2014, variant 13 of Stafford's].
std::uint64_t mixed(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

// An odd number near 2⁶⁴/φ: consecutive multiples differ in many bits.
constexpr std::uint64_t golden = 0x9e3779b97f4a7c15u;

std::uint32_t reversed(std::uint32_t x) {
    x = (x >> 16) | (x << 16);
    x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    return ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
}

// A permutation in which a bit depends on the bits below it only, as each step below has it: adding
// a constant, multiplying by an odd one, and x ^= x·even. On reversed numbers that is a nested
// uniform scramble. The multipliers are arbitrary dense bit patterns, used twice with two keys.
std::uint32_t nested(std::uint32_t x, std::uint64_t key) {
    const std::uint32_t low = std::uint32_t(key), high = std::uint32_t(key >> 32);
    x += low;
    x ^= x * 0x5d2f36aau;
    x *= high | 1u;
    x ^= x * 0xb7a1c5d6u;
    x += high;
    x ^= x * 0x2c9277b6u;
    x *= low | 1u;
    x ^= x * 0x9e6c63d2u;
    return x;
}

// Sobol's second dimension with its bits reversed. The generator matrix is Pascal's triangle modulo
// 2, C(k, j) is odd where the bits of j are among those of k, so the product is a sum over
// supersets, five steps instead of 32.
std::uint32_t pascal(std::uint32_t x) {
    x ^= (x >> 1) & 0x55555555u;
    x ^= (x >> 2) & 0x33333333u;
    x ^= (x >> 4) & 0x0f0f0f0fu;
    x ^= (x >> 8) & 0x00ff00ffu;
    return x ^ ((x >> 16) & 0x0000ffffu);
}

double unit(std::uint32_t x) { return x * 0x1p-32; }

}  // namespace

Sampler::Sampler(std::uint64_t seed, int x, int y, int sample)
    : pixel_(mixed(mixed(seed + golden) ^ (std::uint64_t(std::uint32_t(x)) << 32 | std::uint32_t(y)))),
      sample_(std::uint32_t(sample)) {}

double Sampler::line(std::uint32_t dimension) const {
    const std::uint64_t key = mixed(pixel_ + golden * (std::uint64_t(dimension) + 1));
    return unit(reversed(nested(reversed(nested(reversed(sample_), key)), mixed(key + golden))));
}

Vec2 Sampler::square(std::uint32_t dimension, int part, int parts) const {
    const std::uint64_t key = mixed(pixel_ + golden * (std::uint64_t(dimension) + 1));
    // Shuffled in the order of Owen's scramble, the first 2ᵐ samples remain one block of 2ᵐ.
    const std::uint32_t index = sample_ * std::uint32_t(parts) + std::uint32_t(part);
    const std::uint32_t shuffled = reversed(nested(reversed(index), key));
    const std::uint64_t key_x = mixed(key + golden), key_y = mixed(key + 2 * golden);
    return {unit(reversed(nested(shuffled, key_x))), unit(reversed(nested(pascal(shuffled), key_y)))};
}

namespace {

// Harris 1978, the four-term window with side lobes below -92 dB.
constexpr std::array<double, 4> window = {0.35875, 0.48829, 0.14128, 0.01168};

// ∫ of the filter from -radius to x.
double filter_area(double x) {
    const double turn = std::numbers::pi * x / filter_radius;  // from -π to π
    double sum = 0.5 * window[0] * (turn / std::numbers::pi + 1.0);
    for (int k = 1; k < 4; ++k) sum += window[k] * std::sin(k * turn) / (2 * std::numbers::pi * k);
    return sum / window[0];
}

// The inverse for the left half, at areas (i / steps)²/2: dense at the end, where it is steep.
constexpr int inverse_steps = 512;

std::array<double, inverse_steps + 1> inverse_areas() {
    std::array<double, inverse_steps + 1> offsets{};
    for (int i = 0; i <= inverse_steps; ++i) {
        const double area = 0.5 * i * i / (double(inverse_steps) * inverse_steps);
        double lo = -filter_radius, hi = 0.0;
        while (true) {
            const double mid = 0.5 * (lo + hi);
            if (mid <= lo || mid >= hi) break;
            (filter_area(mid) < area ? lo : hi) = mid;
        }
        offsets[i] = hi;
    }
    return offsets;
}

double filter_quantile(double u) {
    static const auto offsets = inverse_areas();
    const double at = std::sqrt(2 * std::min(u, 1 - u)) * inverse_steps;
    const auto i = std::min(std::size_t(at), std::size_t(inverse_steps - 1));
    const double x = offsets[i] + (offsets[i + 1] - offsets[i]) * (at - double(i));
    return u < 0.5 ? x : -x;
}

}  // namespace

double filter_value(double x) {
    if (std::abs(x) >= filter_radius) return 0.0;
    const double turn = std::numbers::pi * x / filter_radius;
    double sum = window[0];
    for (int k = 1; k < 4; ++k) sum += window[k] * std::cos(k * turn);
    return sum / (2 * filter_radius * window[0]);
}

Vec2 filter_offset(Vec2 u) { return {filter_quantile(u.x), filter_quantile(u.y)}; }

}  // namespace deburr
