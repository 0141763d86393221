// Two independent estimates x, y of one pixel, of n samples each, have E(x − y)²/2 = σ²/n. The mean of it over pixels
// and channels, of values as a screen shows them, falls as 1/n; stratified samples do better, so the number errs to
// the side of more.
#include "raytracer/render/sample_count.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace deburr {
namespace {

// Root mean square of what is left, of a scale from 0 to 1. Chosen: of flat grey areas with it the grain can just be
// seen.
constexpr double accepted_noise = 1.5 / 255;

// Pixels that are looked at along each side, and samples of each estimate.
constexpr int pixels_along = 40, trial_samples = 8;

// Samples of a whole picture, above which more pixels get fewer: noise between small pixels is seen less, and nobody
// waits for ever. 64 for a picture of 3840 x 2160.
constexpr double max_total = 0x1p29;

// The trial's seeds, apart from the picture's own: noise must not be judged by the samples that it keeps.
constexpr std::uint64_t trial_seed = 0x9e3779b97f4a7c15;

double shown(double linear, double scale) {
    const double x = std::clamp(scale * linear, 0.0, 1.0);
    return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

}  // namespace

int sample_count(const Scene& scene, const RayTracer& tracer, const RenderSettings& settings, double exposure) {
    RenderSettings first = settings;
    first.spp = trial_samples;
    first.seed = settings.seed + trial_seed;
    RenderSettings second = first;
    second.seed = first.seed + trial_seed;
    const Integrator a(scene, tracer, first), b(scene, tracer, second);
    const int columns = std::min(settings.width, pixels_along), rows = std::min(settings.height, pixels_along);
    const double scale = std::exp2(exposure);

    std::vector<double> squares(columns * rows);
    tbb::parallel_for(0, columns * rows, [&](int i) {
        const int row = i / columns, column = i % columns;
        const int y = int((row + 0.5) / rows * settings.height);
        // Every other row is shifted, so that no column of a regular model is missed.
        const int x = std::min(int((column + (row % 2 ? 0.75 : 0.25)) / columns * settings.width), settings.width - 1);
        TraceCounters counters;
        const Vec3 one = a.pixel(x, y, nullptr, counters).color, other = b.pixel(x, y, nullptr, counters).color;
        double sum = 0;
        for (int k = 0; k < 3; ++k) {
            const double difference = shown(one[k], scale) - shown(other[k], scale);
            sum += difference * difference / 2;
        }
        squares[i] = sum / 3;
    });
    double mean = 0;
    for (const double square : squares) mean += square / double(squares.size());

    const double needed = trial_samples * mean / (accepted_noise * accepted_noise);
    const double most = std::min(double(max_sample_count), max_total / (double(settings.width) * settings.height));
    return int(std::max(std::min(std::ceil(needed), most), double(min_sample_count)));
}

}  // namespace deburr
