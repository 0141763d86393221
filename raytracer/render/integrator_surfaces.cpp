// Shades batches of opaque surfaces in previews.
#include "raytracer/render/integrator_path.hpp"
#include "raytracer/render/shading_kernels.hpp"

namespace deburr {

void Integrator::shade(const Surfaces& surfaces, const PathOf& path) const {
    const SurfaceBatch& batch = surfaces.batch;
    shading_functions.see(layers_, batch);
    std::uint32_t purpose = first_light;
    for (const LightSource& source : lights_) light(surfaces, source, purpose++, path);
    shading_functions.mirror(layers_, batch);
    find_sky(batch);
    if (polished_) trace_mirrors(surfaces, path);
    shading_functions.shade(scene_.ambient, layers_, batch);
    if (!emits_) return;
    for (std::size_t i = 0; i < batch.count; ++i) {
        const Hit& hit = *surfaces.hits[i];
        if (!(glm::dot(hit.normal, batch.vec(SurfaceField::to_eye, i)) > 0)) continue;
        batch.set(SurfaceField::shaded, i, batch.vec(SurfaceField::shaded, i) + material(hit).emission);
    }
}

// Adds the source's light that the surfaces scatter to the eye to `lit`.
void Integrator::light(const Surfaces& surfaces, const LightSource& source, std::uint32_t purpose,
                       const PathOf& path) const {
    const SurfaceBatch& batch = surfaces.batch;
    const int samples = source.samples();
    // Adds the values of `from` to those of `to`, divided by `many`.
    const auto add = [&batch](SurfaceField to, SurfaceField from, int many) {
        for (int axis = 0; axis < 3; ++axis) {
            double* const sum = batch.array(to, axis);
            const double* const part = batch.array(from, axis);
            for (std::size_t i = 0; i < batch.count; ++i) sum[i] += many == 1 ? part[i] : part[i] / many;
        }
    };
    if (samples > 1)
        for (int axis = 0; axis < 3; ++axis) std::fill_n(batch.array(SurfaceField::lit_by, axis), batch.count, 0.0);
    for (int k = 0; k < samples; ++k) {
        find_incident(surfaces, source, purpose, k, path);
        shading_functions.scatter(layers_, batch);
        hide(surfaces, path);
        add(samples > 1 ? SurfaceField::lit_by : SurfaceField::lit, SurfaceField::scattered, 1);
    }
    if (samples > 1) add(SurfaceField::lit, SurfaceField::lit_by, samples);
}

// Finds the light of sample k of the source.
void Integrator::find_incident(const Surfaces& surfaces, const LightSource& source, std::uint32_t purpose, int k,
                               const PathOf& path) const {
    const SurfaceBatch& batch = surfaces.batch;
    const auto place = [&](std::size_t i) {
        const Path here = path(i);
        return here.sampler.square(here.dimension(purpose), k, source.samples());
    };
    if (source.kind() == Light::Kind::sphere) {
        for (std::size_t i = 0; i < batch.count; ++i) {
            const Incident light = source.at(batch.vec(SurfaceField::position, i), place(i));
            batch.set(SurfaceField::towards, i, light.direction);
            batch.set(SurfaceField::distance, i, light.distance);
            batch.set(SurfaceField::irradiance, i, light.irradiance);
        }
        return;
    }
    if (source.extended())
        for (std::size_t i = 0; i < batch.count; ++i) {
            const Vec2 u = place(i);
            batch.array(SurfaceField::place, 0)[i] = u.x;
            batch.array(SurfaceField::place, 1)[i] = u.y;
        }
    shading_functions.incident(source, batch);
}

// Removes the light of occluded sources from `scattered`.
void Integrator::hide(const Surfaces& surfaces, const PathOf& path) const {
    const SurfaceBatch& batch = surfaces.batch;
    const double* const red = batch.array(SurfaceField::scattered, 0);
    const double* const green = batch.array(SurfaceField::scattered, 1);
    const double* const blue = batch.array(SurfaceField::scattered, 2);
    std::size_t asked = 0;
    for (std::size_t i = 0; i < batch.count; ++i) {
        if (!(red[i] > 0 || green[i] > 0 || blue[i] > 0)) continue;
        surfaces.shadows[asked] = leave(*surfaces.hits[i], batch.vec(SurfaceField::towards, i));
        surfaces.t_max[asked] = batch.get(SurfaceField::distance, i);
        surfaces.shaded[asked++] = std::uint32_t(i);
    }
    if (asked == 0) return;
    if (glass_) {  // shadow rays continue through it
        for (std::size_t s = 0; s < asked; ++s) {
            const std::uint32_t i = surfaces.shaded[s];
            const Vec3 share = transmittance(surfaces.shadows[s], surfaces.t_max[s], path(i));
            batch.set(SurfaceField::scattered, i, batch.vec(SurfaceField::scattered, i) * share);
        }
        return;
    }
    TraceCounters& counters = path(surfaces.shaded[0]).counters;
    if (asked == 1)
        surfaces.hidden[0] = tracer_.any_hit(surfaces.shadows[0], surfaces.t_max[0], counters);
    else
        tracer_.any_hits({surfaces.shadows, asked}, {surfaces.t_max, asked}, surfaces.hidden, counters);
    for (std::size_t s = 0; s < asked; ++s)
        if (surfaces.hidden[s]) batch.set(SurfaceField::scattered, surfaces.shaded[s], Vec3(0.0));
}

// Finds the light that the surfaces reflect from the background.
void Integrator::find_sky(const SurfaceBatch& batch) const {
    if (!sky_.sampled()) return shading_functions.sky(sky_, layers_, batch);
    for (std::size_t i = 0; i < batch.count; ++i) {
        batch.set(SurfaceField::sky, i, sky_.mean(batch.vec(SurfaceField::normal, i)));
        const SurfaceLayer& layer = layers_[std::size_t(batch.layer[i])];
        if (layer.kind() == Material::Kind::matte) continue;
        const Vec3 towards = batch.vec(SurfaceField::towards, i);
        batch.set(SurfaceField::mirrored, i, glm::mix(sky_.towards(towards), sky_.mean(towards), layer.blur()));
    }
}

// Sets `mirrored` of polished surfaces to the light that their mirror ray finds.
void Integrator::trace_mirrors(const Surfaces& surfaces, const PathOf& path_of) const {
    const SurfaceBatch& batch = surfaces.batch;
    for (std::size_t i = 0; i < batch.count; ++i) {
        const SurfaceLayer& layer = layers_[std::size_t(batch.layer[i])];
        if (!layer.polished()) continue;
        const Path path = path_of(i);
        if (path.depth >= scene_.bounces) continue;
        const Vec3 albedo = batch.vec(SurfaceField::layer_albedo, i);
        // A layer that is not smooth has already been lit by the lights.
        Path next = path.reflected(max_component(albedo));
        next.sees_lights = next.sees_lights && layer.smooth();
        batch.set(SurfaceField::mirrored, i,
                  color_along(leave(*surfaces.hits[i], batch.vec(SurfaceField::towards, i)), next));
    }
}

}  // namespace deburr
