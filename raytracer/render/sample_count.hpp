// Chooses the number of samples for a picture whose user gave none.
#pragma once
#include <atomic>

#include "raytracer/render/integrator.hpp"

namespace deburr {

/// Limits of the number of samples per pixel, unless --spp says otherwise.
constexpr int min_sample_count = 16, max_sample_count = 256;
/// The least number for pictures that take long.
constexpr int min_costly_sample_count = 4;

/// The most CPU time for a picture, in seconds (chosen): five minutes on two cores.
constexpr double max_picture_seconds = 600;

/// The chosen number of samples per pixel.
struct SampleCount {
    int samples;
    int wanted;  // more than `samples` if these were reduced to save time
};

/// The number of samples per pixel that leaves noise of about 1.5 steps of 8-bit sRGB on average, within
/// max_picture_seconds; fewer for pictures of many pixels. Both are estimated from pixels all over the whole picture,
/// the time by counting work and not by a clock, so that the number is the same on every machine and for every crop.
/// settings.spp is ignored. `exposure` of the picture is in stops. Once `stop` (may be null) is set, returns soon with
/// any number.
SampleCount sample_count(const Scene& scene, const RayTracer& tracer, const RenderSettings& settings, double exposure,
                         const std::atomic<bool>* stop = nullptr);

}  // namespace deburr
