// How many samples a picture needs that nobody has given a number.
#pragma once
#include "raytracer/render/integrator.hpp"

namespace deburr {

/// Samples that are taken at least and, but for what --spp asks, at most.
constexpr int min_sample_count = 16, max_sample_count = 256;

/// Samples per pixel that leave noise of about one step and a half of 8-bit sRGB in the mean: estimated from pixels
/// spread over the whole picture, and the same on every machine and for every crop. Fewer for pictures of many
/// pixels. settings.spp does not matter. `exposure`: in stops, of the picture that is looked at.
int sample_count(const Scene& scene, const RayTracer& tracer, const RenderSettings& settings, double exposure);

}  // namespace deburr
