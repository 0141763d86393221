#include "raytracer/render/integrator.hpp"

#include <algorithm>

#include "raytracer/render/integrator_path.hpp"
#include "raytracer/render/textures.hpp"

namespace deburr {
namespace {

// Up to this α a metal counts as polished: with one sample its reflection is traced as a mirror's.
// Roughness 0.3; blurrier, the missing blur would be more wrong than a missing object.
constexpr double polished_alpha = 0.09;

// With one sample both ways of glass are traced while they can change the pixel by this much.
constexpr double min_weight = 1.0 / 512;

// Surfaces of glass that a shadow ray passes; beyond more of them it is dark.
constexpr int glass_in_shadow = 16;

// Bounds of the probability that a path goes on by the layer: beside the base, so that neither
// starves, and where it would end otherwise.
constexpr double min_share = 0.1, min_share_alone = 0.25;

// A highlight that a base sees is a caustic: few paths find it, and those are bright. They find it
// with at least this α, dimmer and wider [Kaplanyan & Dachsbacher 2013].
constexpr double caustic_alpha = 0.5;
// The same between rough layers: what one reflects of another's highlights is blurred already, and
// with the other no sharper than this many times the one's α hardly looks different.
constexpr double blur_in_blur = 2.0;

Vec3 towards_ray(Vec3 normal, Vec3 direction) { return glm::dot(normal, direction) > 0 ? -normal : normal; }

double layer_share(double layer, double base) {
    if (layer <= 0) return 0.0;
    if (base <= 0) return glm::clamp(2 * layer, min_share_alone, 1.0);
    return glm::clamp(layer / (layer + base), min_share, 1 - min_share);
}

}  // namespace

Integrator::Integrator(const Scene& scene, const RayTracer& tracer, RenderSettings settings)
    : scene_(scene),
      tracer_(tracer),
      settings_(settings),
      camera_(scene.camera, settings.width, settings.height),
      sky_(scene.background) {
    layers_.reserve(scene.materials.size());
    for (const Material& m : scene.materials) {
        std::size_t first = 0;  // with this layer
        while (first < layers_.size() && !SurfaceLayer::same(scene.materials[first], m)) ++first;
        if (first < layers_.size())
            layers_.push_back(layers_[first]);
        else
            layers_.emplace_back(m);
        glass_ = glass_ || m.kind == Material::Kind::glass;
    }
    for (const Light& light : scene.lights) lights_.emplace_back(light);
}

const Material& Integrator::material(const Hit& hit) const { return scene_.materials[hit.material]; }

Vec3 Integrator::texture_color(const Hit& hit) const { return color_at(material(hit).color, hit.position, hit.normal); }

Vec3 Integrator::color_along(const Ray& ray, const Path& path) const {
    const Hit hit = tracer_.closest_hit(ray, infinity, path.counters);
    const Vec3 color = hit ? color_from(hit, texture_color(hit), ray.direction, path) : sky_.towards(ray.direction);
    return path.sees_lights ? color + lights_seen(ray, hit.t, path) : color;
}

// The other half of what lit() takes by its samples of the light [balance heuristic, Veach 1997].
Vec3 Integrator::lights_seen(const Ray& ray, double t_max, const Path& path) const {
    Vec3 sum(0.0);
    for (const LightSource& source : lights_) {
        const auto light = source.seen(ray, t_max);
        if (!(light.density > 0)) continue;
        sum += light.radiance / (1 + source.samples() * light.density / path.density);
    }
    return sum;
}

// What the surface scatters to the eye of light that nothing hides; of `samples` that are drawn from its source.
Vec3 Integrator::scattered(const Surface& surface, const Incident& light, int samples) const {
    if (!(brightest(light.irradiance) > 0)) return Vec3(0.0);
    const Bsdf& bsdf = surface.bsdf;
    const Bsdf::Value value = bsdf.value(light.direction);
    Vec3 sum = value.base;
    if (surface.layer_share > 0 && light.density < infinity)
        sum +=
            value.layer / (1 + surface.layer_share * bsdf.layer_density(light.direction) / (samples * light.density));
    else
        sum += value.layer;
    return sum * light.irradiance;
}

Vec3 Integrator::lit(const Surface& surface, const Path& path) const {
    Vec3 sum(0.0);
    std::uint32_t dimension = path.dimension(first_light);
    for (const LightSource& source : lights_) {
        const int samples = path.scattered ? 1 : source.samples();
        Vec3 here(0.0);
        for (int k = 0; k < samples; ++k) {
            const Incident light = incident(source, surface.hit, path.sampler, dimension, k, samples);
            const Vec3 light_here = scattered(surface, light, samples);
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
        if (material(next).kind != Material::Kind::glass) break;
        const double cosine = glm::dot(next.normal, light.direction);
        share *= texture_color(next) * (1 - fresnel_dielectric(cosine, material(next).ior));
        left -= next.t;
        ray = leave(next, light.direction);
    }
    return Vec3(0.0);
}

Integrator::Surface::Surface(const Integrator& in, const Hit& hit, Vec3 color_here, Vec3 direction, const Path& path)
    : hit(hit),
      bsdf(in.layers_[hit.material], color_here, towards_ray(hit.normal, direction), -direction, path.blur),
      last(path.without_noise || path.scattered || path.depth >= in.scene_.bounces) {
    if (last) return;
    base = in.sky_.black() ? 0.0 : brightest(bsdf.base_albedo());
    // Plastic that the camera sees takes both ways: the layer's colour is not the base's, and a
    // choice between them would be noise in all channels where the base is dark.
    both = path.depth == 0 && bsdf.layer().kind() == Material::Kind::plastic;
    layer_share = both ? 1.0 : deburr::layer_share(brightest(bsdf.layer_albedo()), base);
}

Vec3 Integrator::color_from(const Hit& hit, Vec3 color_here, Vec3 direction, const Path& path) const {
    if (material(hit).kind == Material::Kind::glass) return color_of_glass(hit, color_here, direction, path);
    const Surface s(*this, hit, color_here, direction, path);
    return color_of(s, lit(s, path), path);
}

Vec3 Integrator::color_of(const Surface& s, Vec3 lit, const Path& path) const {
    const Bsdf& bsdf = s.bsdf;
    const Vec3 ambient = bsdf.base_albedo() * scene_.ambient;
    if (s.last) return ambient + lit + reflected_without_noise(bsdf, s.hit, path);

    const double share = s.layer_share, base_share = s.both ? 1.0 : 1 - share;
    const double chosen = s.both ? 0.0 : path.sampler.line(path.dimension(choice));
    Vec3 color = ambient + lit;
    Vec3 direction, weight;
    if (chosen < share && bsdf.sample_layer(path.sampler.square(path.dimension(layer_turn)), direction, weight)) {
        const SurfaceLayer& layer = bsdf.layer();
        Path next = path.reflected(share * bsdf.layer_density(direction));
        if (!layer.smooth()) next.blur = std::min(caustic_alpha, std::max(path.blur, blur_in_blur * layer.ggx().alpha));
        color += weight / share * color_along(leave(s.hit, direction), next);
    }
    if (s.base > 0 && (s.both || chosen >= share)) {
        weight = bsdf.sample_base(path.sampler.square(path.dimension(turn)), direction);
        Path next = path.on();
        next.scattered = true;
        next.blur = caustic_alpha;
        next.sees_lights = false;
        color += weight / base_share * color_along(leave(s.hit, direction), next);
    }
    return color;
}

// What the surface returns of the background and, if it is polished, of other surfaces.
Vec3 Integrator::reflected_without_noise(const Bsdf& bsdf, const Hit& hit, const Path& path) const {
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
    Path next = path.reflected(infinity, brightest(albedo));
    next.sees_lights = next.sees_lights && layer.smooth();
    return base + albedo * color_along(leave(hit, direction), next);
}

// The first surface of glass is followed both ways with any number of samples: a highlight that is
// found by one sample in 25 is noise. For the same reason deeper ones show no area lights.
// The radiance in a denser medium is not scaled by its squared index: light seen from outside has
// left it again.
Vec3 Integrator::color_of_glass(const Hit& hit, Vec3 tint, Vec3 direction, const Path& path) const {
    const SurfaceLayer& layer = layers_[hit.material];
    const Vec3 to_eye = -direction;
    const bool inside = glm::dot(hit.normal, direction) > 0;
    const Vec3 normal = inside ? -hit.normal : hit.normal;
    const double ior = inside ? 1 / layer.ior() : layer.ior();
    const bool rough = !layer.smooth() && !path.without_noise;
    const Vec2 u = path.sampler.square(path.dimension(turn));
    const Vec3 facet = rough ? layer.ggx().facet(to_eye, normal, u) : normal;

    const Vec3 back = reflected(to_eye, facet);
    Vec3 through(0.0);
    const bool passes = refracted(to_eye, facet, ior, through);
    const double share = passes ? fresnel_dielectric(glm::dot(to_eye, facet), ior) : 1.0;
    if (path.depth >= scene_.bounces)
        return share * sky_.towards(back) + (passes ? (1 - share) * tint * sky_.towards(through) : Vec3(0.0));

    // `side` is 1 for a reflection, -1 for light that passes.
    auto along = [&](Vec3 direction, double side, const Path& next) {
        if (next.weight < min_weight) return sky_.towards(direction);
        double seen = 1.0;
        if (rough) {
            const double cosine = side * glm::dot(direction, normal);
            if (!(cosine > 0)) return Vec3(0.0);  // it meets another facet
            seen = layer.ggx().shadowing(cosine, glm::dot(to_eye, normal));
        }
        return seen * color_along(leave(hit, direction), next);
    };
    Path passing = path.on(1 - share), returning = path.reflected(infinity, share);
    passing.sees_lights = false;
    returning.sees_lights = path.depth == 0;
    if (path.without_noise || path.depth == 0) {
        Vec3 color = share * along(back, 1, returning);
        if (passes) color += (1 - share) * tint * along(through, -1, passing);
        return color;
    }
    passing.weight = returning.weight = path.weight;
    if (path.sampler.line(path.dimension(choice)) < share) return along(back, 1, returning);
    return tint * along(through, -1, passing);
}

}  // namespace deburr
