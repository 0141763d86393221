// What the samples of a pixel add up to, exactly.
//
// Sums are whole numbers of 2⁻⁶⁰, so that they depend on neither the order of samples nor how they were parted into
// passes, runs and machines: a picture after n samples is a function of n. A sample is rounded to 2⁻⁶⁰ once, which is
// less than a double loses above 2⁻⁷, and what is brighter than 2⁴⁶ counts as that.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>

#include "raytracer/image/film.hpp"
#include "raytracer/trace/ray_tracer.hpp"

namespace deburr {

/// Samples `first` to `end` - 1 of every pixel.
struct SampleRange {
    int first = 0, end = 0;

    bool operator==(const SampleRange&) const = default;
};

/// The pass that follows once the samples before `done` are taken: 1 sample, then 1, 2, 4, … 32, 32, …; none, and so
/// first = end = all.end, at the end. Every power of two from the beginning on ends a pass.
SampleRange next_pass(SampleRange all, int done);

/// A sum of numbers, in 2⁻⁶⁰.
class ExactSum {
public:
    using Whole = __int128;

    ExactSum() = default;
    explicit ExactSum(Whole value) : value_(value) {}

    /// x is finite.
    ExactSum& operator+=(double x) {
        // In 64 bits where they are enough: a conversion to 128 is a call.
        if (std::abs(x) < 8)
            value_ += std::int64_t(x * unit);
        else
            value_ += Whole(std::min(std::max(x, -most), most) * unit);
        return *this;
    }
    ExactSum& operator+=(ExactSum other) {
        value_ += other.value_;
        return *this;
    }
    /// The sum of one number, x finite.
    static double rounded(double x) {
        // Nothing is lost on the way back: a double's whole part is a double.
        return std::abs(x) < 8 ? double(std::int64_t(x * unit)) / unit : (ExactSum() += x).value();
    }
    ExactSum operator-(ExactSum other) const { return ExactSum(value_ - other.value_); }
    double value() const {
        const auto low = std::int64_t(value_);  // the same, where it is enough
        return (Whole(low) == value_ ? double(low) : double(value_)) / unit;
    }
    bool operator==(const ExactSum&) const = default;

private:
    static constexpr double unit = 0x1p60, most = 0x1p46;
    Whole value_ = 0;
};

struct ColorSum {
    std::array<ExactSum, 3> of;

    ColorSum& operator+=(Vec3 color) {
        for (int k = 0; k < 3; ++k) of[k] += color[k];
        return *this;
    }
    ColorSum& operator+=(const ColorSum& other) {
        for (int k = 0; k < 3; ++k) of[k] += other.of[k];
        return *this;
    }
    ColorSum operator-(const ColorSum& other) const {
        return {{of[0] - other.of[0], of[1] - other.of[1], of[2] - other.of[2]}};
    }
    Vec3 value() const { return {of[0].value(), of[1].value(), of[2].value()}; }
    bool operator==(const ColorSum&) const = default;
};

struct PixelSums {
    ColorSum color;
    std::uint32_t hits = 0, samples = 0;
    std::uint64_t is_quiet = 0;  // 1: its cell has so little noise that it gets no more samples (noise_bound.hpp)

    PixelSums& operator+=(const PixelSums& other);
};
static_assert(sizeof(PixelSums) == 64);  // without gaps: it is written as it is

/// Layers of a pixel, of which those for denoisers are kept apart.
struct LayerSums {
    PixelLayers rest;  // of the centre's ray; but cost and shares of solids are sums
    ColorSum albedo, guide_normal;

    /// Adds later samples, without the centre's ray.
    LayerSums& operator+=(const LayerSums& other);
    void set_center(const Hit& hit, Vec3 direction, Vec3 forward);
};

/// Where a block's samples go, row by row; `layers` may be null, and `halves` is used with a noise bound only.
struct SampleArrays {
    PixelSums* sums = nullptr;
    LayerSums* layers = nullptr;
    ColorSum* halves = nullptr;
};

/// Averages of what there is; without samples the empty pixel.
inline Pixel mean(const PixelSums& sums) {
    if (sums.samples == 0) return {};
    return {sums.color.value() / double(sums.samples), double(sums.hits) / sums.samples};
}
PixelLayers mean(const LayerSums& sums, std::uint32_t samples);

}  // namespace deburr
