// An unbiased path tracer: as many bounces as it takes, lights and reflections weighed against each other.
//
// At every surface that is no mirror, light is asked for where it comes from (emitters.hpp), and the path goes on where
// the surface scatters it (scattering.hpp). What both ways find is weighed by multiple importance sampling [balance
// heuristic, Veach 1997]; point and directional lights are found by the first alone, the background by the second.
// Where the camera looks, every light is sampled unless they are many; further on, one is chosen as likely as it is
// important. A path ends by Russian roulette, never by a depth.
//
// Two departures, both told in docs/scenes.md. Light of point and directional lights passes glass straight on, tinted
// and weakened by Fresnel, since no path finds such a light behind it by chance. And unless Scene::caustics is set, so
// does all other light, and no path goes from a rough surface over glass to a light; and the highlights that a rough
// surface would see on others, and seldom find, are wider and dimmer, of the same energy [Kaplanyan & Dachsbacher
// 2013].
#pragma once
#include <memory>
#include <vector>

#include "raytracer/render/emitters.hpp"
#include "raytracer/render/integrator.hpp"
#include "raytracer/render/scattering.hpp"

namespace deburr {

class PathIntegrator {
public:
    /// Keeps references to both.
    PathIntegrator(const Scene& scene, const RayTracer& tracer, const RenderSettings& settings);
    /// As Integrator::take.
    void take(SampleRange range, const Window& block, PixelSums* sums, LayerSums* layers,
              TraceCounters& counters) const;

private:
    class Batch;
    void samples(Batch& batch, int x, int y, std::uint32_t pixel, SampleRange range) const;

    bool lets_light_pass(const Material& m) const { return m.kind == Material::Kind::glass || m.transmission > 0; }
    // Where the material's roughness is a texture, `choice` from 0 to 1 takes one of the two levels around its value.
    const ScatteringMaterial& material_at(const Hit& hit, int blur, double choice) const;

    const Scene& scene_;
    const RayTracer& tracer_;
    RenderSettings settings_;
    PinholeCamera camera_;
    AlbedoTables tables_;
    // By blur (path_blur.hpp), then by material, which begins at its first level.
    std::vector<std::vector<ScatteringMaterial>> materials_;
    std::vector<std::size_t> first_levels_;
    SkyLight seen_, sky_;  // by the camera; by all else
    Emitters emitters_;
    bool glass_ = false;  // there is some
};

}  // namespace deburr
