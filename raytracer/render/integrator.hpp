// Colour of a pixel: camera rays, lights, materials.
//
// Every random number is a function of (seed, pixel, sample, dimension), so a pixel's value depends
// on neither threads, tiles nor crop.
//
// There are two integrators. `path` (path_integrator.hpp) finds all light, with noise that samples take away. `preview`
// has no noise unless area lights bring it, and finds
//
//   lights      Every surface but smooth mirrors and glass gets the light of every source, each with its shadow rays
//               (point, directional: one; area, sphere: `samples` of them, stratified). Glass lets light pass straight
//               on, tinted and weakened by Fresnel: its shadows are soft in tone but have no caustics. Lights are seen
//               in polished surfaces only.
//   ambient     seen by diffuse surfaces from all around, never hidden.
//   background  The background lights diffuse surfaces as if nothing hid it; plastic and rough metal reflect the
//               background, blurred by roughness, and no objects. Mirrors, polished metal and glass are traced, glass
//               both ways and as if it were polished, with at most Scene::bounces rays; beyond, the background stands
//               in for what was not traced.
//
// A preview has one sample a pixel, through its centre, or several through its filter, each of them as said.
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

enum class IntegratorKind { automatic, preview, path };

struct RenderSettings {
    int width = 0, height = 0;  // of the whole picture
    int spp = 1;                // 1: one ray through the pixel's centre
    std::uint64_t seed = 0;
    bool cost = true;        // PixelLayers::cost is asked for: then no two pixels' rays are traced together
    bool background = true;  // false: where the camera sees it, colours are 0, so that alpha has weighed the others
    double noise = 0;        // > 0: a block of paths ends where it has this little, with `spp` samples at most
    IntegratorKind integrator = IntegratorKind::automatic;  // a preview with one sample, else paths

    bool uses_paths() const {
        return integrator == IntegratorKind::path || (integrator == IntegratorKind::automatic && spp > 1);
    }
};

class PathIntegrator;

class Integrator {
public:
    /// Keeps references to both.
    Integrator(const Scene& scene, const RayTracer& tracer, RenderSettings settings);
    /// Takes these samples of a block's pixels, each by itself, and adds them to what earlier ranges have brought, row
    /// by row; to `layers`, too, unless it is null. Whether a picture has one sample, and so rays through centres, is
    /// what settings.spp says; settings.noise does not matter.
    void take(SampleRange range, const Window& block, PixelSums* sums, LayerSums* layers,
              TraceCounters& counters) const;
    /// A block with all of its samples, row by row; sets `layers` unless it is null. Neither ever holds a NaN.
    void block(const Window& block, Pixel* pixels, PixelLayers* layers, TraceCounters& counters) const;
    /// The same of one pixel.
    Pixel pixel(int x, int y, PixelLayers* layers, TraceCounters& counters) const;

private:
    struct Path;
    struct Surfaces;
    template <std::size_t capacity>
    struct SurfaceRoom;
    class CameraRays;
    using PathOf = std::function<Path(std::size_t)>;  // that meets surface i
    // block() of one sample a pixel.
    void take_centers(const Window& block, Pixel* pixels, TraceCounters& counters) const;
    Vec3 color_along(const Ray& ray, const Path& path) const;
    Vec3 lights_seen(const Ray& ray, double t_max) const;
    // `color_here`, `tint`: the material's at the hit.
    Vec3 color_from(const Hit& hit, Vec3 color_here, Vec3 direction, const Path& path) const;
    Vec3 color_of_glass(const Hit& hit, Vec3 tint, Vec3 direction, const Path& path) const;
    // One more surface, which `direction` meets; keeps a pointer to the hit.
    template <std::size_t capacity>
    void add(SurfaceRoom<capacity>& room, const Hit& hit, Vec3 color_here, Vec3 direction) const;
    // Sets `shaded` of all.
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
    PinholeCamera camera_;
    std::vector<SurfaceLayer> layers_;  // of the materials
    std::vector<LightSource> lights_;
    SkyLight seen_, sky_;                          // by the camera; by all else
    bool glass_ = false, emits_ = false;           // is there any
    bool polished_ = false;                        // may mirrors be traced
    bool samples_lights_ = false;                  // is any extended
    std::shared_ptr<const PathIntegrator> paths_;  // null: a preview
};

}  // namespace deburr
