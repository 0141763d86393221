// The integrators: from camera rays, lights and materials to the colour of a pixel.
//
// Every random number is a function of (seed, pixel, sample, dimension), so a pixel's value depends on neither threads,
// tiles nor crops.
//
// There are two integrators. `path` (path_integrator.hpp) finds all light, with noise that more samples reduce.
// `preview` has no noise except from area lights, and finds
//
//   lights      Surfaces except smooth mirrors and glass get the light of every source, with shadow rays for each
//               (point, directional: one; area, sphere: `samples`, stratified). Glass transmits light straight on,
//               tinted and weakened by Fresnel: its shadows are soft in tone, without caustics. Lights themselves are
//               visible in polished surfaces only.
//   ambient     Constant light from all around on diffuse surfaces, never occluded.
//   background  The background lights diffuse surfaces as if nothing occluded it; plastic and rough metal reflect the
//               background, blurred by roughness, but no objects. Mirrors, polished metal and glass are traced, glass
//               both by reflection and refraction and as if it were polished, with at most Scene::bounces rays; beyond,
//               the background replaces what was not traced.
//
// A preview has one sample per pixel, through its center, or several through its filter, each computed as above.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "raytracer/image/film.hpp"
#include "raytracer/render/bsdf.hpp"
#include "raytracer/render/camera.hpp"
#include "raytracer/render/lights.hpp"
#include "raytracer/render/pixel_sums.hpp"
#include "raytracer/render/surface_batch.hpp"
#include "raytracer/scene/scene.hpp"
#include "raytracer/trace/ray_tracer.hpp"

namespace deburr {

/// Which integrator renders; automatic: a preview for one sample per pixel, else paths.
enum class IntegratorKind { automatic, preview, path };

/// Settings of a rendering.
struct RenderSettings {
    int width = 0, height = 0;  // of the whole picture
    int spp = 1;                // samples per pixel; 1: one ray through its center
    std::uint64_t seed = 0;
    bool cost = true;        // PixelLayers::cost is wanted, so no two pixels' rays may be traced together
    bool background = true;  // false: colours are 0 where the camera sees the background (premultiplied by alpha)
    double noise = 0;        // > 0: blocks end at this noise (noise_bound.hpp), with at most `spp` samples
    IntegratorKind integrator = IntegratorKind::automatic;

    bool uses_paths() const {
        return integrator == IntegratorKind::path || (integrator == IntegratorKind::automatic && spp > 1);
    }
};

class PathIntegrator;

/// Renders blocks of a picture. Its functions may be called from many threads.
class Integrator {
public:
    /// Keeps references to the scene and the tracer.
    Integrator(const Scene& scene, const RayTracer& tracer, RenderSettings settings);
    /// Takes these samples of a block's pixels and adds each to `sums`, and to `layers` unless that is null (both row
    /// by row). Samples are independent of the ranges in which they are taken. settings.spp decides whether the picture
    /// has one sample, through the pixels' centers; settings.noise is ignored.
    void take(SampleRange range, const Window& block, PixelSums* sums, LayerSums* layers,
              TraceCounters& counters) const;
    /// Renders a block with all of its samples: sets `pixels`, and `layers` unless that is null (both row by row). They
    /// never contain a NaN.
    void block(const Window& block, Pixel* pixels, PixelLayers* layers, TraceCounters& counters) const;
    /// block() for one pixel.
    Pixel pixel(int x, int y, PixelLayers* layers, TraceCounters& counters) const;

private:
    struct Path;
    struct Surfaces;
    template <std::size_t capacity>
    struct SurfaceRoom;
    class CameraRays;
    using PathOf = std::function<Path(std::size_t)>;  // returns the path that meets surface i
    // block() for one sample per pixel.
    void take_centers(const Window& block, Pixel* pixels, TraceCounters& counters) const;
    Vec3 color_along(const Ray& ray, const Path& path) const;
    Vec3 lights_seen(const Ray& ray, double t_max) const;
    // `color_here` and `tint` are the material's colour at the hit.
    Vec3 color_from(const Hit& hit, Vec3 color_here, Vec3 direction, const Path& path) const;
    Vec3 color_of_glass(const Hit& hit, Vec3 tint, Vec3 direction, const Path& path) const;
    // Appends a surface that `direction` meets; keeps a pointer to the hit.
    template <std::size_t capacity>
    void add(SurfaceRoom<capacity>& room, const Hit& hit, Vec3 color_here, Vec3 direction) const;
    // Sets `shaded` of all surfaces.
    void shade(const Surfaces& surfaces, const PathOf& path) const;
    void light(const Surfaces& surfaces, const LightSource& source, std::uint32_t purpose, const PathOf& path) const;
    void find_incident(const Surfaces& surfaces, const LightSource& source, std::uint32_t purpose, int k,
                       const PathOf& path) const;
    void hide(const Surfaces& surfaces, const PathOf& path) const;
    void find_sky(const SurfaceBatch& batch) const;
    void trace_mirrors(const Surfaces& surfaces, const PathOf& path) const;
    Vec3 transmittance(Ray ray, double left, const Path& path) const;
    const Material& material(const Hit& hit) const;
    Vec3 texture_color(const Hit& hit) const;

    const Scene& scene_;
    const RayTracer& tracer_;
    RenderSettings settings_;
    ProjectiveCamera camera_;
    std::vector<SurfaceLayer> layers_;  // by material
    std::vector<LightSource> lights_;
    SkyLight seen_, sky_;                          // background as the camera sees it; as lights all else
    bool glass_ = false, emits_ = false;           // whether there is glass; whether materials emit
    bool polished_ = false;                        // whether there may be mirrors to trace
    bool samples_lights_ = false;                  // whether any light is extended
    std::shared_ptr<const PathIntegrator> paths_;  // null: a preview
};

}  // namespace deburr
