#include "raytracer/render/path_integrator.hpp"

#include <algorithm>

#include "raytracer/render/path_batch.hpp"
#include "raytracer/render/textures.hpp"

namespace deburr {
namespace {

// Dimensions of random numbers that a path draws once: for the filter and for the lens.
constexpr std::uint32_t filter_draw = 0xffffffffu, lens_draw = 0xfffffffeu;

// Side of a patch of pixels whose rays are traced together.
constexpr int path_patch = 4;

}  // namespace

PathIntegrator::PathIntegrator(const Scene& scene, const RayTracer& tracer, const RenderSettings& settings)
    : scene_(scene),
      tracer_(tracer),
      settings_(settings),
      camera_(scene.camera, settings.width, settings.height),
      seen_(scene.background),
      sky_(scene.lighting()),
      emitters_(scene, sky_) {
    std::size_t levels = 0;
    for (const Material& m : scene.materials) {
        first_levels_.push_back(levels);
        levels += m.roughness_texture ? roughness_steps + 1 : 1;
        glass_ = glass_ || lets_light_pass(m);
    }
    materials_.resize(scene.caustics ? 1 : blurs);
    for (std::size_t blur = 0; blur < materials_.size(); ++blur)
        for (Material m : scene.materials) {
            if (!m.roughness_texture) {
                materials_[blur].emplace_back(m, tables_, blur_alphas[blur]);
                continue;
            }
            for (int i = 0; i <= roughness_steps; ++i) {
                m.roughness = double(i) / roughness_steps;
                materials_[blur].emplace_back(m, tables_, blur_alphas[blur]);
            }
        }
}

const ScatteringMaterial& PathIntegrator::material_at(const Hit& hit, int blur, double choice) const {
    std::size_t level = first_levels_[hit.material];
    if (const Texture* roughness = scene_.materials[hit.material].roughness_texture.get()) {
        const double at = value_at(*roughness, hit.position, hit.normal) * roughness_steps;
        if (at >= 0) level += std::size_t(std::min(at + choice, double(roughness_steps)));
    }
    return materials_[blur][level];
}

// Adds the samples of one pixel, whose index is `pixel`, to the batch.
void PathIntegrator::samples(Batch& batch, int x, int y, std::uint32_t pixel, SampleRange range) const {
    for (int s = range.first; s < range.end; ++s) {
        const Sampler sampler(settings_.seed, x, y, s);
        const Vec2 offset = filter_offset(sampler.square(filter_draw));
        const double at_x = x + 0.5 + offset.x, at_y = y + 0.5 + offset.y;
        batch.add(camera_.has_lens() ? camera_.ray(at_x, at_y, sampler.square(lens_draw)) : camera_.ray(at_x, at_y),
                  {sampler, pixel, false, true});
    }
}

void PathIntegrator::take(SampleRange range, const Window& block, PixelSums* sums, LayerSums* layers,
                          TraceCounters& counters) const {
    const bool apart = layers && settings_.cost;
    thread_local Batch::Memory memory;
    Batch batch(*this, sums, layers, counters, memory);
    std::uint64_t evaluations = counters.evaluations;
    const auto pixel = [&](int x, int y) {
        const auto i = std::uint32_t(y * block.width + x);
        x += block.x;
        y += block.y;
        if (layers && range.first == 0)
            batch.add(camera_.ray(x + 0.5, y + 0.5), {Sampler(settings_.seed, x, y, 0), i, true, false});
        samples(batch, x, y, i, range);
        sums[i].samples += std::uint32_t(range.end - range.first);
        if (!apart) return;
        batch.finish();
        layers[i].rest.cost += double(counters.evaluations - evaluations);
        evaluations = counters.evaluations;
    };
    for (int top = 0; top < block.height; top += path_patch)
        for (int left = 0; left < block.width; left += path_patch)
            for (int y = top; y < std::min(top + path_patch, block.height); ++y)
                for (int x = left; x < std::min(left + path_patch, block.width); ++x) pixel(x, y);
    batch.finish();
}

}  // namespace deburr
