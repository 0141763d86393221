// Exact sums of a pixel's samples.
//
// Sums are integers in units of 2⁻⁶⁰, so that they depend on neither the order of samples nor their distribution over
// passes, runs and machines: a picture after n samples is a function of n. A sample is rounded to 2⁻⁶⁰ once, which is
// less than a double's rounding above 2⁻⁷; values above 2⁴⁶ count as 2⁴⁶.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>

#include "raytracer/image/film.hpp"
#include "raytracer/trace/ray_tracer.hpp"

namespace deburr {

/// The samples first … end − 1 of every pixel.
struct SampleRange {
    int first = 0, end = 0;

    bool operator==(const SampleRange&) const = default;
};

/// The pass after all samples before `done` are taken: of 1 sample, then 1, 2, 4, … 32, 32, …; empty (first = end =
/// all.end) at the end. Every power of two, counted from the beginning, ends a pass.
SampleRange next_pass(SampleRange all, int done);

/// An exact sum of numbers, in units of 2⁻⁶⁰.
class ExactSum {
public:
    using Whole = __int128;

    ExactSum() = default;
    explicit ExactSum(Whole value) : value_(value) {}

    /// Adds a number, which must be finite.
    ExactSum& operator+=(double x) {
        // In 64 bits if that is enough, because conversion to 128 bits is a function call.
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
    /// The number as a sum would hold it; x must be finite.
    static double rounded(double x) {
        // Exact on the way back, since a double's integer part is a double.
        return std::abs(x) < 8 ? double(std::int64_t(x * unit)) / unit : (ExactSum() += x).value();
    }
    ExactSum operator-(ExactSum other) const { return ExactSum(value_ - other.value_); }
    double value() const {
        const auto low = std::int64_t(value_);  // equal to value_ if it fits
        return (Whole(low) == value_ ? double(low) : double(value_)) / unit;
    }
    bool operator==(const ExactSum&) const = default;

private:
    static constexpr double unit = 0x1p60, most = 0x1p46;
    Whole value_ = 0;
};

/// An exact sum of colours.
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

/// The sums of one pixel.
struct PixelSums {
    ColorSum color;
    std::uint32_t hits = 0, samples = 0;  // samples that hit a solid; all samples
    std::uint64_t is_quiet = 0;  // 1: its cell has so little noise that it gets no more samples (noise_bound.hpp)

    PixelSums& operator+=(const PixelSums& other);
};
static_assert(sizeof(PixelSums) == 64);  // without padding, since it is written to files as it is

/// The layers of one pixel; those for denoisers are exact sums.
struct LayerSums {
    PixelLayers rest;  // of the center's ray, except for sums of cost and of solids' shares
    ColorSum albedo, guide_normal;

    /// Adds later samples; the center's ray stays.
    LayerSums& operator+=(const LayerSums& other);
    /// Sets the layers of the center's ray, which has this direction; `forward` is the camera's.
    void set_center(const Hit& hit, Vec3 direction, Vec3 forward);
};

/// The arrays to which a block's samples are added, row by row. `layers` may be null; `halves` is used with a noise
/// bound only.
struct SampleArrays {
    PixelSums* sums = nullptr;
    LayerSums* layers = nullptr;
    ColorSum* halves = nullptr;
};

/// The averages; an empty pixel without samples.
inline Pixel mean(const PixelSums& sums) {
    if (sums.samples == 0) return {};
    return {sums.color.value() / double(sums.samples), double(sums.hits) / sums.samples};
}
PixelLayers mean(const LayerSums& sums, std::uint32_t samples);

}  // namespace deburr
