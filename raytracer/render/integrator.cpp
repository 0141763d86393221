#include "raytracer/render/integrator.hpp"

#include <algorithm>

#include "raytracer/render/bump.hpp"
#include "raytracer/render/integrator_path.hpp"
#include "raytracer/render/path_integrator.hpp"
#include "raytracer/render/textures.hpp"

namespace deburr {
namespace {

// Reflection and refraction of glass are both traced while they can change the pixel by this much.
constexpr double min_weight = 1.0 / 512;

// Most glass surfaces that a shadow ray passes; further ones block it.
constexpr int glass_in_shadow = 16;

}  // namespace

Integrator::Integrator(const Scene& scene, const RayTracer& tracer, RenderSettings settings)
    : scene_(scene),
      tracer_(tracer),
      settings_(settings),
      camera_(scene.camera, settings.width, settings.height),
      seen_(scene.background),
      sky_(scene.lighting()) {
    if (settings.uses_paths()) {
        paths_ = std::make_shared<const PathIntegrator>(scene, tracer, settings);
        return;
    }
    layers_.reserve(scene.materials.size());
    for (const Material& m : scene.materials) {
        std::size_t first = 0;  // the first material with this layer
        while (first < layers_.size() && !SurfaceLayer::same(scene.materials[first], m)) ++first;
        if (first < layers_.size())
            layers_.push_back(layers_[first]);
        else
            layers_.emplace_back(m);
        glass_ = glass_ || layers_.back().kind() == Material::Kind::glass;
        emits_ = emits_ || m.emission != Vec3(0.0);
        polished_ = polished_ || layers_.back().polished();
    }
    for (const Light& light : scene.lights) {
        lights_.emplace_back(light);
        samples_lights_ = samples_lights_ || lights_.back().extended();
    }
    if (!sky_.sun().shines()) return;
    Light sun;
    sun.kind = Light::Kind::directional;
    sun.direction = -sky_.sun().direction;
    sun.color = sky_.sun().irradiance();
    lights_.emplace_back(sun);
}

const Material& Integrator::material(const Hit& hit) const { return scene_.materials[hit.material]; }

Vec3 Integrator::texture_color(const Hit& hit) const { return color_at(material(hit).color, hit.position, hit.normal); }

Vec3 Integrator::color_along(const Ray& ray, const Path& path) const {
    const Hit hit = tracer_.closest_hit(ray, infinity, path.counters);
    const Vec3 color = hit ? color_from(hit, texture_color(hit), ray.direction, path) : sky_.towards(ray.direction);
    return path.sees_lights ? color + lights_seen(ray, hit.t) : color;
}

Vec3 Integrator::lights_seen(const Ray& ray, double t_max) const {
    Vec3 sum(0.0);
    for (const LightSource& source : lights_) sum += source.seen(ray, t_max).radiance;
    return sum;
}

// The share of light that glass transmits along a shadow ray's first `left` units; 0 if anything else is in the way.
Vec3 Integrator::transmittance(Ray ray, double left, const Path& path) const {
    Vec3 share(1.0);
    for (int i = 0; i < glass_in_shadow; ++i) {
        const Hit next = tracer_.closest_hit(ray, left, path.counters);
        if (!next) return share;
        const SurfaceLayer& layer = layers_[next.material];
        if (layer.kind() != Material::Kind::glass) break;
        const double cosine = glm::dot(next.normal, ray.direction);
        share *= texture_color(next) * (1 - fresnel_dielectric(cosine, layer.ior()));
        left -= next.t;
        ray = leave(next, ray.direction);
    }
    return Vec3(0.0);
}

Vec3 Integrator::color_from(const Hit& hit, Vec3 color_here, Vec3 direction, const Path& path) const {
    if (layers_[hit.material].kind() == Material::Kind::glass) return color_of_glass(hit, color_here, direction, path);
    SurfaceRoom<8> room;
    add(room, hit, color_here, direction);
    const Surfaces surface = room.surfaces();
    shade(surface, [&path](std::size_t) { return path; });
    return surface.batch.vec(SurfaceField::shaded, 0);
}

// Reflections at deeper surfaces than the first show no area lights, which would be caustics. The radiance in a denser
// medium is not scaled by the square of its index, since light that is seen from outside has left it again.
Vec3 Integrator::color_of_glass(const Hit& hit, Vec3 tint, Vec3 direction, const Path& path) const {
    const SurfaceLayer& layer = layers_[hit.material];
    const Vec3 to_eye = -direction;
    const bool inside = glm::dot(hit.normal, direction) > 0;
    const Vec3 outward = shading_normal(material(hit), hit.position, hit.normal, to_eye);
    const Vec3 normal = inside ? -outward : outward;
    const double ior = inside ? 1 / layer.ior() : layer.ior();

    const Vec3 back = reflected(to_eye, normal);
    Vec3 through(0.0);
    const bool passes = refracted(to_eye, normal, ior, through);
    const double share = passes ? fresnel_dielectric(glm::dot(to_eye, normal), ior) : 1.0;
    if (path.depth >= scene_.bounces)
        return share * sky_.towards(back) + (passes ? (1 - share) * tint * sky_.towards(through) : Vec3(0.0));

    const auto along = [&](Vec3 onwards, const Path& next) {
        return next.weight < min_weight ? sky_.towards(onwards) : color_along(leave(hit, onwards), next);
    };
    Path passing = path.on(1 - share), returning = path.reflected(share);
    passing.sees_lights = false;
    returning.sees_lights = path.depth == 0;
    Vec3 color = share * along(back, returning);
    if (passes) color += (1 - share) * tint * along(through, passing);
    return color;
}

}  // namespace deburr
