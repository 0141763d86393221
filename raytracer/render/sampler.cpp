#include "raytracer/render/sampler.hpp"

#include <array>
#include <cmath>

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

// A permutation in which each bit depends only on the bits below it, as in each step: adding a constant, multiplying by
// an odd number, and x ^= x·even. On bit-reversed numbers this is a nested uniform scramble. The multipliers are
// arbitrary dense bit patterns, used twice with two keys.
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

// Sobol's second dimension, bit-reversed. The generator matrix is Pascal's triangle modulo 2; C(k, j) is odd where the
// bits of j are among those of k, so the product is a sum over supersets: five steps instead of 32.
std::uint32_t pascal(std::uint32_t x) {
    x ^= (x >> 1) & 0x55555555u;
    x ^= (x >> 2) & 0x33333333u;
    x ^= (x >> 4) & 0x0f0f0f0fu;
    x ^= (x >> 8) & 0x00ff00ffu;
    return x ^ ((x >> 16) & 0x0000ffffu);
}

// The digits that a pixel's position in its block adds to its points: the first 32 coefficients of the functions zᶜ/qʲ,
// q = z² + z + 1, at z = 0 (for x) and at z = 1 (for y). c and j select a bit of the position: c is 0 for columns, j
// counts levels from the finest, whose four pixels have j = 1. The first digit is bit 0.
constexpr int block_levels = Sampler::block_levels;
using PlaceDigits = std::array<std::array<std::uint32_t, 1 << (2 * block_levels)>, 2>;

// A power series divided by q, modulo 2: p[l] = s[l] + p[l - 1] + p[l - 2].
constexpr std::uint32_t divided(std::uint32_t s) {
    std::uint32_t p = 0;
    for (int l = 0; l < 32; ++l) {
        std::uint32_t digit = s >> l & 1;
        if (l >= 1) digit ^= p >> (l - 1) & 1;
        if (l >= 2) digit ^= p >> (l - 2) & 1;
        p |= digit << l;
    }
    return p;
}

constexpr PlaceDigits all_place_digits() {
    PlaceDigits digits{};
    for (int around = 0; around < 2; ++around)
        for (int c = 0; c < 2; ++c) {
            // 1, or z, which is w + 1 around z = 1, where q = w² + w + 1 again.
            std::uint32_t series = c == 0 ? 1 : around == 0 ? 2 : 3;
            for (int j = 1; j <= block_levels; ++j) {
                series = divided(series);
                const std::uint32_t bit = 1u << (2 * (block_levels - j) + c);
                for (std::uint32_t place = 0; place < digits[0].size(); ++place)
                    if (place & bit) digits[around][place] ^= series;
            }
        }
    return digits;
}

constexpr PlaceDigits place_digits = all_place_digits();

// The bits of a column or row in its block, the coarsest first, at every other bit.
constexpr std::array<std::uint32_t, 1 << block_levels> place_bits = [] {
    std::array<std::uint32_t, 1 << block_levels> all{};
    for (std::uint32_t at = 0; at < all.size(); ++at)
        for (int level = 0; level < block_levels; ++level)
            all[at] |= (at >> (block_levels - 1 - level) & 1) << (2 * level);
    return all;
}();

double unit(std::uint32_t x) { return x * 0x1p-32; }

}  // namespace

Sampler::Sampler(std::uint64_t seed, int x, int y, int sample) : sample_(std::uint32_t(sample)) {
    const std::uint64_t picture = mixed(seed + golden);
    const auto of_place = [&](int column, int row) {
        return mixed(picture ^ (std::uint64_t(std::uint32_t(column)) << 32 | std::uint32_t(row)));
    };
    block_ = of_place(x >> block_levels, y >> block_levels);
    pixel_ = of_place(x, y);
    place_ = place_bits[std::size_t(x) % place_bits.size()] | place_bits[std::size_t(y) % place_bits.size()] << 1;
}

Sampler::Point Sampler::point(std::uint32_t dimension, std::uint32_t index) const {
    Point p;
    p.key = mixed(block_ + golden * (std::uint64_t(dimension) + 1));
    // Each pixel takes the samples from 2ᵐ to 2ᵐ⁺¹ in its own order, and none earlier: a nested scramble of the bits
    // below the highest one.
    const std::uint32_t kept = index ? (2u << __builtin_clz(index)) - 1 : ~0u;
    const std::uint32_t in_order = reversed(index);
    p.index = reversed((in_order & kept) | (nested(in_order, mixed(p.key ^ pixel_)) & ~kept));
    p.place = nested(place_, p.key) & ((1u << (2 * block_levels)) - 1);
    return p;
}

double Sampler::line(std::uint32_t dimension) const {
    const Point p = point(dimension, sample_);
    return unit(reversed(nested(p.index ^ place_digits[0][p.place], mixed(p.key + golden))));
}

Vec2 Sampler::square(std::uint32_t dimension, int part, int parts) const {
    const Point p = point(dimension, sample_ * std::uint32_t(parts) + std::uint32_t(part));
    const std::uint32_t x = p.index ^ place_digits[0][p.place], y = pascal(p.index) ^ place_digits[1][p.place];
    return {unit(reversed(nested(x, mixed(p.key + golden)))), unit(reversed(nested(y, mixed(p.key + 2 * golden))))};
}

namespace {

// [Harris 1978], the four-term window with side lobes below -92 dB.
constexpr std::array<double, 4> window = {0.35875, 0.48829, 0.14128, 0.01168};

// The integral of the filter from -filter_radius to x.
double filter_area(double x) {
    const double turn = pi * x / filter_radius;  // from -π to π
    double sum = 0.5 * window[0] * (turn / pi + 1.0);
    for (int k = 1; k < 4; ++k) sum += window[k] * std::sin(k * turn) / (2 * pi * k);
    return sum / window[0];
}

// The inverse of filter_area for the left half, at areas (i / steps)²/2: dense at the end, where it is steep.
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
    const double turn = pi * x / filter_radius;
    double sum = window[0];
    for (int k = 1; k < 4; ++k) sum += window[k] * std::cos(k * turn);
    return sum / (2 * filter_radius * window[0]);
}

Vec2 filter_offset(Vec2 u) { return {filter_quantile(u.x), filter_quantile(u.y)}; }

}  // namespace deburr
