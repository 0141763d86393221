// Colour of a pixel: camera rays, lights, materials.
//
// Every random number is a function of (seed, pixel, sample, dimension), so a pixel's value depends
// on neither threads, tiles nor crop.
//
// What is computed, by the number of samples per pixel:
//
//   lights      At any number, every surface but smooth mirrors and glass gets the light of every
//               source, each with its shadow rays (point, directional: one; area: `samples` of
//               them, stratified). Glass lets light pass straight on, tinted and weakened by
//               Fresnel: its shadows are soft in tone but have no caustics.
//   ambient     At any number: seen by diffuse surfaces from all around, never hidden.
//   one sample  has no noise unless area lights bring it, and costs matte, plastic and rough metal
//               one camera ray and the shadow rays. The background lights diffuse surfaces as if
//               nothing hid it; plastic and rough metal reflect the background, blurred by
//               roughness, and no objects. Mirrors, polished metal and glass are traced, glass both
//               ways.
//   more        Every sample follows one path, two from plastic or glass at its start. A
//               reflection is sampled and traced for every material, weighed against area lights by
//               multiple importance sampling. In a rough reflection the highlights of other rough
//               surfaces are blurred, or they would be noise. Where there is a background,
//               diffuse surfaces send a ray to find out what they see of it; a surface it meets
//               instead is shaded as with one sample, so light is scattered diffusely at most
//               twice. In the open, where no surface sees another, that agrees with one sample;
//               in corners it darkens and colours.
//
// A path has at most Scene::bounces rays after the camera's; beyond, the background stands in for
// what was not traced. Area lights are seen in reflections only (lights.hpp), and by glass only
// where the camera sees the glass.
#pragma once
#include <cstdint>
#include <vector>

#include "raytracer/image/film.hpp"
#include "raytracer/render/bsdf.hpp"
#include "raytracer/render/camera.hpp"
#include "raytracer/render/lights.hpp"
#include "raytracer/scene/scene.hpp"
#include "raytracer/trace/ray_tracer.hpp"

namespace deburr {

struct RenderSettings {
    int width = 0, height = 0;  // of the whole picture
    int spp = 1;                // 1: one ray through the pixel's centre
    std::uint64_t seed = 0;
    bool cost = true;        // PixelLayers::cost is asked for: then no two pixels' rays are traced together
    bool background = true;  // false: where the camera sees it, colours are 0, so that alpha has weighed the others
};

class Integrator {
public:
    /// Keeps references to both.
    Integrator(const Scene& scene, const RayTracer& tracer, RenderSettings settings);
    /// Of a block, row by row; sets `layers` unless it is null. Neither ever holds a NaN.
    void block(const Window& block, Pixel* pixels, PixelLayers* layers, TraceCounters& counters) const;
    /// The same of one pixel.
    Pixel pixel(int x, int y, PixelLayers* layers, TraceCounters& counters) const;

private:
    struct Path;
    struct Surface;
    class CameraRays;
    Vec3 color_along(const Ray& ray, const Path& path) const;
    Vec3 lights_seen(const Ray& ray, double t_max, const Path& path) const;
    // `color_here`, `tint`: the material's at the hit.
    Vec3 color_from(const Hit& hit, Vec3 color_here, Vec3 direction, const Path& path) const;
    Vec3 color_of_glass(const Hit& hit, Vec3 tint, Vec3 direction, const Path& path) const;
    Vec3 color_of(const Surface& surface, Vec3 lit, const Path& path) const;
    Vec3 lit(const Surface& surface, const Path& path) const;
    static Incident incident(const LightSource& source, const Hit& hit, const Sampler& sampler, std::uint32_t dimension,
                             int k, int samples);
    Vec3 scattered(const Surface& surface, const Incident& light, int samples) const;
    Vec3 reflected_without_noise(const Bsdf& bsdf, const Hit& hit, const Path& path) const;
    Vec3 transmittance(const Hit& hit, const Incident& light, const Path& path) const;
    const Material& material(const Hit& hit) const;
    Vec3 texture_color(const Hit& hit) const;

    const Scene& scene_;
    const RayTracer& tracer_;
    RenderSettings settings_;
    PinholeCamera camera_;
    std::vector<SurfaceLayer> layers_;  // of the materials
    std::vector<LightSource> lights_;
    SkyLight sky_;
    bool glass_ = false;  // is there any
};

}  // namespace deburr
