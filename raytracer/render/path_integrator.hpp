// A path tracer with bounces until Russian roulette, which combines light sampling and scattering.
//
// At every surface except mirrors, light is sampled from the emitters (emitters.hpp), and the path continues in a
// direction sampled from the surface's scattering (scattering.hpp). Both estimates are combined by multiple importance
// sampling [balance heuristic, Veach 1997]; point and directional lights are found by the first only, the background by
// the second. At the first surface, every light is sampled unless they are many; at later ones, a single light is
// chosen by importance. A path ends by Russian roulette, never at a fixed depth.
//
// Two approximations, described in docs/scenes.md: light of point and directional lights passes glass straight on,
// tinted and weakened by Fresnel, since no path finds such a light behind glass by chance. And unless Scene::caustics
// is set, all other light does so, too, and no path goes from a rough surface over glass to a light; and highlights
// that a rough surface would see on others, but would find rarely, are wider and dimmer, with the same energy
// [Kaplanyan & Dachsbacher 2013].
#pragma once
#include <memory>
#include <vector>

#include "raytracer/render/emitters.hpp"
#include "raytracer/render/integrator.hpp"
#include "raytracer/render/scattering.hpp"

namespace deburr {

/// Implements Integrator for paths.
class PathIntegrator {
public:
    /// Keeps references to the scene and the tracer.
    PathIntegrator(const Scene& scene, const RayTracer& tracer, const RenderSettings& settings);
    /// See Integrator::take().
    void take(SampleRange range, const Window& block, PixelSums* sums, LayerSums* layers,
              TraceCounters& counters) const;

private:
    class Batch;
    class StraightTransmission;
    void samples(Batch& batch, int x, int y, std::uint32_t pixel, SampleRange range) const;

    bool lets_light_pass(const Material& m) const { return m.kind == Material::Kind::glass || m.transmission > 0; }
    // If the material's roughness is a texture, `choice` in [0, 1) chooses one of the two levels around its value.
    const ScatteringMaterial& material_at(const Hit& hit, int blur, double choice) const;

    const Scene& scene_;
    const RayTracer& tracer_;
    RenderSettings settings_;
    ProjectiveCamera camera_;
    AlbedoTables tables_;
    // Indexed by blur (path_blur.hpp), then by level; a material's levels begin at first_levels_.
    std::vector<std::vector<ScatteringMaterial>> materials_;
    std::vector<std::size_t> first_levels_;
    SkyLight seen_, sky_;  // background as the camera sees it; as lights all else
    Emitters emitters_;
    bool glass_ = false;  // whether there is glass
};

}  // namespace deburr
