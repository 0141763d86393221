// How many samples a picture needs that nobody has given a number.
#pragma once
#include <atomic>

#include "raytracer/render/integrator.hpp"

namespace deburr {

/// Samples that are taken at least and, but for what --spp asks, at most.
constexpr int min_sample_count = 16, max_sample_count = 256;
/// Samples that even a picture gets that takes long.
constexpr int min_costly_sample_count = 4;

/// CPU time that a picture may take, in seconds: five minutes on two cores. Chosen.
constexpr double max_picture_seconds = 600;

struct SampleCount {
    int samples;
    int wanted;  // more than `samples` where these are fewer for the sake of time
};

/// Samples per pixel that leave noise of about one step and a half of 8-bit sRGB in the mean, and no more than may be
/// had within max_picture_seconds. Both are estimated from pixels spread over the whole picture, the time by a count
/// of the work and not by a clock, so that the number is the same on every machine and for every crop. Fewer for
/// pictures of many pixels. settings.spp does not matter. `exposure`: in stops, of the picture that is looked at.
/// Once `stop` is set, unless it is null, any number comes soon.
SampleCount sample_count(const Scene& scene, const RayTracer& tracer, const RenderSettings& settings, double exposure,
                         const std::atomic<bool>* stop = nullptr);

}  // namespace deburr
