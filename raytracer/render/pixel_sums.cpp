#include "raytracer/render/pixel_sums.hpp"

#include <algorithm>

namespace deburr {
namespace {

// Most samples of a pass: a tile of them is soon done, and its scheduling costs little in comparison.
constexpr int largest_pass = 32;

}  // namespace

SampleRange next_pass(SampleRange all, int done) {
    done = std::max(done, all.first);
    return {std::min(done, all.end), std::min(done + std::clamp(done - all.first, 1, largest_pass), all.end)};
}

PixelSums& PixelSums::operator+=(const PixelSums& other) {
    color += other.color;
    hits += other.hits;
    samples += other.samples;
    is_quiet |= other.is_quiet;
    return *this;
}

LayerSums& LayerSums::operator+=(const LayerSums& other) {
    albedo += other.albedo;
    guide_normal += other.guide_normal;
    rest.cost += other.rest.cost;
    for (int k = 0; k < SolidShares::ranks; ++k)
        if (other.rest.solids.id[k] != 0) rest.solids.add(other.rest.solids.id[k], other.rest.solids.share[k]);
    return *this;
}

void LayerSums::set_center(const Hit& hit, Vec3 direction, Vec3 forward) {
    rest.position = finite_or_zero(hit.position);
    rest.normal = finite_or_zero(hit.normal);
    rest.z = hit.t * glm::dot(direction, forward);
    rest.id = std::uint32_t(hit.solid + 1);
}

PixelLayers mean(const LayerSums& sums, std::uint32_t samples) {
    PixelLayers layers = sums.rest;
    if (samples == 0) return layers;
    layers.albedo = sums.albedo.value() / double(samples);
    layers.guide_normal = sums.guide_normal.value() / double(samples);
    layers.solids.divide(samples);
    return layers;
}

}  // namespace deburr
