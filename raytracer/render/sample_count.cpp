// Two independent estimates x, y of one pixel with n samples each have E(x − y)²/2 = σ²/n. Its mean over pixels and
// channels, in display values, falls as 1/n; stratified samples do better, so the number errs on the side of more.
#include "raytracer/render/sample_count.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace deburr {
namespace {

// Accepted root mean square of the noise, on a scale from 0 to 1 (chosen): in flat grey areas this grain is just
// visible.
constexpr double accepted_noise = 1.5 / 255;

// Trial pixels along each side, and samples of each estimate.
constexpr int pixels_along = 40, trial_samples = 8;

// Most samples of a whole picture; pictures with more pixels get fewer for each, since noise is less visible between
// small pixels: 64 for 3840 x 2160.
constexpr double max_total = 0x1p29;

// CPU time for what tracers count. The estimate was 0.4 to 1.7 times the real time of eight of the scenes in scenes/ on
// one core, 1/2.6 of that of bearing.lua and 1/7 of that of convolution.lua, whose densities are more expensive.
constexpr double seconds_per_ray = 1e-7, seconds_per_cell = 3e-8, seconds_per_evaluation = 1e-7;

double estimated_seconds(const TraceCounters& c) {
    return seconds_per_ray * double(c.rays + c.shadow_rays) + seconds_per_cell * double(c.cells) +
           seconds_per_evaluation * double(c.evaluations);
}

// The trial's seeds differ from the picture's: noise must not be judged by the samples that the picture uses.
constexpr std::uint64_t trial_seed = 0x9e3779b97f4a7c15;

double shown(double linear, double scale) {
    const double x = std::clamp(scale * linear, 0.0, 1.0);
    return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

}  // namespace

SampleCount sample_count(const Scene& scene, const RayTracer& tracer, const RenderSettings& settings, double exposure,
                         const std::atomic<bool>* stop) {
    RenderSettings first = settings;
    first.spp = trial_samples;
    first.seed = settings.seed + trial_seed;
    RenderSettings second = first;
    second.seed = first.seed + trial_seed;
    const Integrator a(scene, tracer, first), b(scene, tracer, second);
    const int columns = std::min(settings.width, pixels_along), rows = std::min(settings.height, pixels_along);
    const double scale = std::exp2(exposure);

    std::vector<double> squares(columns * rows), seconds(columns * rows);
    tbb::parallel_for(0, columns * rows, [&](int i) {
        if (stop && *stop) return;
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
        seconds[i] = estimated_seconds(counters);
    });
    if (stop && *stop) return {min_sample_count, min_sample_count};
    double mean = 0, trial_seconds = 0;
    for (const double square : squares) mean += square / double(squares.size());
    for (const double s : seconds) trial_seconds += s;
    const double pixels = double(settings.width) * settings.height;
    const double seconds_per_sample = trial_seconds / (2 * trial_samples * double(seconds.size())) * pixels;

    const double needed = trial_samples * mean / (accepted_noise * accepted_noise);
    const double most = std::min(double(max_sample_count), max_total / pixels);
    const int wanted = int(std::max(std::min(std::ceil(needed), most), double(min_sample_count)));
    const double affordable = std::max(max_picture_seconds / seconds_per_sample, double(min_costly_sample_count));
    return {int(std::min(affordable, double(wanted))), wanted};
}

}  // namespace deburr
