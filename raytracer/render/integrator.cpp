#include "raytracer/render/integrator.hpp"

#include <algorithm>

#include "raytracer/render/bump.hpp"
#include "raytracer/render/integrator_path.hpp"
#include "raytracer/render/path_integrator.hpp"
#include "raytracer/render/textures.hpp"

namespace deburr {
namespace {

// Up to this α a metal counts as polished: its reflection is traced as a mirror's.
// Roughness 0.3; blurrier, the missing blur would be more wrong than a missing object.
constexpr double polished_alpha = 0.09;

// Both ways of glass are traced while they can change the pixel by this much.
constexpr double min_weight = 1.0 / 512;

// Surfaces of glass that a shadow ray passes; beyond more of them it is dark.
constexpr int glass_in_shadow = 16;

Vec3 towards_ray(Vec3 normal, Vec3 direction) { return glm::dot(normal, direction) > 0 ? -normal : normal; }

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
        std::size_t first = 0;  // with this layer
        while (first < layers_.size() && !SurfaceLayer::same(scene.materials[first], m)) ++first;
        if (first < layers_.size())
            layers_.push_back(layers_[first]);
        else
            layers_.emplace_back(m);
        glass_ = glass_ || layers_.back().kind() == Material::Kind::glass;
    }
    for (const Light& light : scene.lights) lights_.emplace_back(light);
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

// What the surface scatters to the eye of light that nothing hides.
Vec3 Integrator::scattered(const Surface& surface, const Incident& light) const {
    if (!(brightest(light.irradiance) > 0)) return Vec3(0.0);
    const Bsdf::Value value = surface.bsdf.value(light.direction);
    return (value.base + value.layer) * light.irradiance;
}

Vec3 Integrator::lit(const Surface& surface, const Path& path) const {
    Vec3 sum(0.0);
    std::uint32_t dimension = path.dimension(first_light);
    for (const LightSource& source : lights_) {
        const int samples = source.samples();
        Vec3 here(0.0);
        for (int k = 0; k < samples; ++k) {
            const Incident light = incident(source, surface.hit, path.sampler, dimension, k, samples);
            const Vec3 light_here = scattered(surface, light);
            if (brightest(light_here) > 0) here += light_here * transmittance(surface.hit, light, path);
        }
        sum += here / double(samples);
        ++dimension;
    }
    return sum;
}

Incident Integrator::incident(const LightSource& source, const Hit& hit, const Sampler& sampler,
                              std::uint32_t dimension, int k, int samples) {
    return source.at(hit.position, source.extended() ? sampler.square(dimension, k, samples) : Vec2(0.5));
}

Vec3 Integrator::transmittance(const Hit& hit, const Incident& light, const Path& path) const {
    Ray ray = leave(hit, light.direction);
    if (!glass_) return tracer_.any_hit(ray, light.distance, path.counters) ? Vec3(0.0) : Vec3(1.0);
    Vec3 share(1.0);
    double left = light.distance;
    for (int i = 0; i < glass_in_shadow; ++i) {
        const Hit next = tracer_.closest_hit(ray, left, path.counters);
        if (!next) return share;
        const SurfaceLayer& layer = layers_[next.material];
        if (layer.kind() != Material::Kind::glass) break;
        const double cosine = glm::dot(next.normal, light.direction);
        share *= texture_color(next) * (1 - fresnel_dielectric(cosine, layer.ior()));
        left -= next.t;
        ray = leave(next, light.direction);
    }
    return Vec3(0.0);
}

Integrator::Surface::Surface(const Integrator& in, const Hit& of_hit, Vec3 color_here, Vec3 direction)
    : hit(of_hit),
      bsdf(in.layers_[hit.material], color_here,
           towards_ray(shading_normal(in.material(hit), hit.position, hit.normal, -direction), direction), -direction),
      emission(glm::dot(hit.normal, direction) < 0 ? in.material(hit).emission : Vec3(0.0)) {}

Vec3 Integrator::color_from(const Hit& hit, Vec3 color_here, Vec3 direction, const Path& path) const {
    if (layers_[hit.material].kind() == Material::Kind::glass) return color_of_glass(hit, color_here, direction, path);
    const Surface s(*this, hit, color_here, direction);
    return color_of(s, lit(s, path), path);
}

Vec3 Integrator::color_of(const Surface& s, Vec3 lit, const Path& path) const {
    const Vec3 ambient = s.bsdf.base_albedo() * scene_.ambient;
    return ambient + lit + reflected_light(s.bsdf, s.hit, path) + s.emission;
}

// What the surface returns of the background and, if it is polished, of other surfaces.
Vec3 Integrator::reflected_light(const Bsdf& bsdf, const Hit& hit, const Path& path) const {
    const Vec3 base = bsdf.base_albedo() * sky_.mean(bsdf.normal());
    const SurfaceLayer& layer = bsdf.layer();
    if (layer.kind() == Material::Kind::matte) return base;
    const double alpha = layer.smooth() ? 0.0 : std::min(1.0, layer.ggx().alpha);
    const bool polished = layer.smooth() || (layer.kind() == Material::Kind::metal && alpha <= polished_alpha);
    const Vec3 direction = reflected(bsdf.to_eye(), bsdf.normal());
    const Vec3 albedo = bsdf.layer_albedo();
    if (!polished || path.depth >= scene_.bounces)
        return base + albedo * glm::mix(sky_.towards(direction), sky_.mean(direction), alpha);
    // Where the layer is not smooth lit() has found the lights already.
    Path next = path.reflected(brightest(albedo));
    next.sees_lights = next.sees_lights && layer.smooth();
    return base + albedo * color_along(leave(hit, direction), next);
}

// Deeper surfaces than the first show no area lights: those would be caustics.
// The radiance in a denser medium is not scaled by its squared index: light seen from outside has
// left it again.
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
