// Traces camera paths together, one bounce at a time, and shades the surfaces that they meet. Part of the
// implementation of path_integrator.cpp.
#pragma once
#include <algorithm>

#include "raytracer/render/bump.hpp"
#include "raytracer/render/path_blur.hpp"
#include "raytracer/render/path_integrator.hpp"
#include "raytracer/render/straight_transmission.hpp"
#include "raytracer/render/textures.hpp"

namespace deburr {

// The random numbers that a path draws at each depth, as dimensions of its sampler.
enum PathDraw : std::uint32_t {
    lobe,
    lobe_direction,
    roulette,
    chosen_light,
    light_places,
    roughness_level = 63,
    draws_a_depth = 64
};

// Up to this many lights are all sampled at the first surface; each has a dimension of its own.
inline constexpr std::size_t max_all_lights = 16;
static_assert(light_places + max_all_lights <= roughness_level);

// Added to the dimensions of a path that was split from another.
inline constexpr std::uint32_t split_draws = 1u << 30;

// Paths of a batch: several packets, whose hits fit into the processor's cache.
inline constexpr std::size_t max_paths = 128;

// Russian roulette begins at this depth, for paths that carry less than 1/survival_factor: earlier, it adds noise and
// saves no time (120x80 pixels of the teapot at 64 samples, from depth 2 without the factor: 1.9 times the error in
// 0.84 of the time). Beyond last_certain, even paths between white surfaces may end.
inline constexpr int first_roulette = 3, last_certain = 32;
inline constexpr double survival_factor = 8;
inline constexpr double min_survival = 0.05, max_late_survival = 0.95;

/// A batch of paths for one block of the picture.
class PathIntegrator::Batch {
public:
    // The use of a camera ray's result.
    struct Use {
        Sampler sampler;
        std::uint32_t pixel;  // index in the block
        bool center, sample;  // for layers of the center's ray; for the colour
    };
    // The state of a path.
    struct Path {
        Ray ray;
        Vec3 throughput{1.0}, color{0.0};
        double density = infinity;  // with which the ray was sampled; infinity: by a mirror or the camera
        Vec3 from{0.0};             // the point where it was sampled
        double importance = 0.0;    // of all emitters there; 0: each of them was sampled
        std::uint32_t draws = 0;    // added to its dimensions
        std::uint32_t parent = 0;   // index of the path that it was split from
        int blur = 0;
        bool over_glass = false;  // whether it met glass since the last rough surface
        bool diffused = false;    // whether a rough surface scattered it
        bool guides = true;       // whether it met only mirrors and polished glass so far
    };
    // The light that a path gets if a shadow ray is not occluded.
    struct Shadow {
        Vec3 color;
        std::uint32_t path;
    };
    // Memory that a thread reuses for every block.
    struct Memory {
        std::vector<Use> uses;
        std::vector<Path> paths;
        std::vector<std::uint32_t> alive;
        std::vector<Ray> rays, shadow_rays;
        std::vector<Hit> hits = std::vector<Hit>(max_paths);
        std::vector<double> shadow_ends;
        std::vector<Shadow> shadows;
        std::unique_ptr<bool[]> hidden;
        std::size_t hidden_size = 0;
    };

    /// Results are added to `sums` and, unless it is null, `layers`, row by row.
    Batch(const PathIntegrator& integrator, PixelSums* sums, LayerSums* layers, TraceCounters& counters, Memory& memory)
        : in_(integrator),
          straight_(integrator, counters),
          sums_(sums),
          layers_(layers),
          counters_(counters),
          m_(memory) {
        clear();
    }

    /// Adds a camera ray; a full batch is traced at once.
    void add(const Ray& ray, const Use& use) {
        m_.paths.push_back({.ray = ray, .from = ray.origin});
        m_.uses.push_back(use);
        if (m_.paths.size() == max_paths) finish();
    }

    /// Traces all paths to their ends.
    void finish() {
        m_.alive.clear();
        rays_ = m_.paths.size();
        for (std::uint32_t i = 0; i < rays_; ++i) m_.alive.push_back(i);
        for (depth_ = 0; !m_.alive.empty(); ++depth_) bounce();
        // In order of the paths, so that a sample does not depend on the rest of the batch.
        for (std::size_t i = rays_; i < m_.paths.size(); ++i) m_.paths[m_.paths[i].parent].color += m_.paths[i].color;
        for (std::size_t i = 0; i < rays_; ++i)
            if (m_.uses[i].sample) sums_[m_.uses[i].pixel].color += finite_or_zero(m_.paths[i].color);
        clear();
    }

private:
    void clear() {
        m_.paths.clear();
        m_.uses.clear();
    }

    // The dimension of a random number at the present depth.
    std::uint32_t dimension(const Path& path, std::uint32_t draw) const {
        return path.draws + std::uint32_t(depth_) * draws_a_depth + draw;
    }

    // Traces all living paths to their next surface and shades it.
    void bounce() {
        m_.shadows.clear();
        m_.shadow_rays.clear();
        m_.shadow_ends.clear();
        if (depth_ == 0) {
            m_.rays.clear();
            for (const std::uint32_t i : m_.alive) m_.rays.push_back(m_.paths[i].ray);
            in_.tracer_.closest_hits(m_.rays, m_.hits.data(), counters_);
        }
        std::size_t left = 0;
        const std::size_t old_paths = m_.paths.size();
        for (std::size_t k = 0; k < m_.alive.size(); ++k) {
            const std::uint32_t i = m_.alive[k];
            Path& path = m_.paths[i];
            const Hit hit = depth_ == 0 ? m_.hits[k] : in_.tracer_.closest_hit(path.ray, infinity, counters_);
            if (depth_ == 0 && !begin(i, hit)) continue;
            if (shade(i, hit)) m_.alive[left++] = i;
        }
        m_.alive.resize(left);
        for (std::size_t i = old_paths; i < m_.paths.size(); ++i) m_.alive.push_back(std::uint32_t(i));
        if (m_.shadows.empty()) return;
        if (m_.hidden_size < m_.shadows.size()) {
            m_.hidden.reset(new bool[m_.shadows.size()]);
            m_.hidden_size = m_.shadows.size();
        }
        if (depth_ == 0)
            in_.tracer_.any_hits(m_.shadow_rays, m_.shadow_ends, m_.hidden.get(), counters_);
        else
            for (std::size_t s = 0; s < m_.shadows.size(); ++s)
                m_.hidden[s] = in_.tracer_.any_hit(m_.shadow_rays[s], m_.shadow_ends[s], counters_);
        for (std::size_t s = 0; s < m_.shadows.size(); ++s)
            if (!m_.hidden[s]) m_.paths[m_.shadows[s].path].color += m_.shadows[s].color;
    }

    // Sets the layers of the center's ray; false if the path's colour is not wanted.
    bool begin(std::uint32_t i, const Hit& hit) {
        const Use& use = m_.uses[i];
        const Vec3 direction = m_.paths[i].ray.direction;
        LayerSums* layers = layers_ ? layers_ + use.pixel : nullptr;
        if (use.center && layers && hit) layers->set_center(hit, direction, in_.camera_.forward());
        return use.sample;
    }

    // The weight of light found by scattering that sampling the emitter could have found, too.
    double reflection_weight(const Path& path, std::size_t emitter, double density) const {
        if (path.density == infinity || !(density > 0)) return 1;
        const double times = path.importance > 0 ? in_.emitters_.importance(emitter, path.from) / path.importance : 1.0;
        return path.density / (path.density + times * density);
    }

    // Light that was already counted as passing straight through glass is not found again behind it.
    bool is_counted_already(const Path& path) const { return !in_.scene_.caustics && path.over_glass && path.diffused; }

    // Adds the light of invisible lights that the ray meets before t_max.
    void take_lights(Path& path, double t_max) const {
        if (depth_ > 0 && !is_counted_already(path))
            in_.emitters_.for_each_invisible(path.ray, t_max, [&](const Emitters::Met& met) {
                path.color += path.throughput * met.radiance * reflection_weight(path, met.emitter, met.density);
            });
    }

    void take_emission(Path& path, const Hit& hit, const Material& material) const {
        if (!(max_component(material.emission) > 0) || glm::dot(hit.normal, path.ray.direction) > 0) return;
        double weight = 1;
        if (const auto sampled = in_.emitters_.of_solid(hit.solid, path.from)) {
            if (is_counted_already(path)) return;
            weight = reflection_weight(path, sampled->emitter, sampled->density);
        }
        path.color += path.throughput * material.emission * weight;
    }

    void take_background(Path& path) const {
        const Vec3 direction = path.ray.direction;
        if (depth_ == 0) {
            if (!in_.settings_.background) return;
            path.color += in_.seen_.towards(direction);
            if (in_.seen_.sun().covers(direction)) path.color += in_.seen_.sun().radiance;
            return;
        }
        in_.emitters_.for_each_at_infinity(direction, [&](const Emitters::Met& met) {
            if (met.density > 0 && is_counted_already(path)) return;
            path.color += path.throughput * met.radiance * reflection_weight(path, met.emitter, met.density);
        });
    }

    // Adds the layers for denoisers, once for a path.
    void add_guides(Path& path, const Use& use, Vec3 color, Vec3 normal) {
        if (layers_ && path.guides) {
            const Vec3 share = glm::min(path.throughput, Vec3(1.0));
            layers_[use.pixel].albedo += finite_or_zero(share * color);
            layers_[use.pixel].guide_normal += finite_or_zero(max_component(share) * normal);
        }
        path.guides = false;
    }

    // The material at the hit; if its metallic share is a texture, it is composed in `mixed`.
    const ScatteringMaterial& material_at(const Path& path, const Use& use, const Hit& hit, const Material& material,
                                          ScatteringMaterial& mixed) const {
        const ScatteringMaterial& level = in_.material_at(
            hit, path.blur, material.roughness_texture ? use.sampler.line(dimension(path, roughness_level)) : 0.0);
        if (!material.metallic_texture) return level;
        mixed = level;
        mixed.set_metallic(glm::clamp(value_at(*material.metallic_texture, hit.position, hit.normal), 0.0, 1.0));
        return mixed;
    }

    // Adds the light at the surface that a path has met, and continues the path; false if it ends.
    bool shade(std::uint32_t i, const Hit& hit) {
        Path& path = m_.paths[i];
        const Use use = m_.uses[i];  // a copy, since the list may grow
        const Emitters::Met met = in_.emitters_.met(path.ray, hit.t);
        take_lights(path, std::min(hit.t, met.t));
        if (met.t < hit.t) {
            if (depth_ == 0) ++sums_[use.pixel].hits;
            add_guides(path, use, Vec3(1.0), -path.ray.direction);
            if (!is_counted_already(path))
                path.color += path.throughput * met.radiance * reflection_weight(path, met.emitter, met.density);
            return false;
        }
        if (!hit) {
            take_background(path);
            if (depth_ > 0) add_guides(path, use, Vec3(1.0), Vec3(0.0));  // light only, as of a white surface
            return false;
        }
        const Material& material = in_.scene_.materials[hit.material];
        const Vec3 color = color_at(material.color, hit.position, hit.normal), to_eye = -path.ray.direction;
        if (depth_ == 0) {
            ++sums_[use.pixel].hits;
            if (layers_) layers_[use.pixel].rest.solids.add(std::uint32_t(hit.solid + 1));
        }
        take_emission(path, hit, material);
        ScatteringMaterial mixed;
        Scattering surface(material_at(path, use, hit, material, mixed), color,
                           shading_normal(material, hit.position, hit.normal, to_eye), hit.normal, to_eye);
        if (surface.diffuses()) add_guides(path, use, color, surface.normal());
        path.color += path.throughput * surface.base_albedo() * in_.scene_.ambient;
        // At the first surface, choosing at random between a base and a layer of different colours would be noisy.
        const bool both = depth_ == 0 && surface.split();
        double importance = 0;
        if (surface.diffuses()) importance = take_samples(i, hit, surface);
        if (both) {
            Path other = path;
            other.parent = i;
            other.draws = split_draws;
            other.color = Vec3(0.0);
            if (go_on(other, use.sampler, hit, surface, importance, 1.0)) {
                m_.paths.push_back(other);
                m_.uses.push_back(use);
            }
        }
        return go_on(m_.paths[i], m_.uses[i].sampler, hit, surface, importance, 0.0);
    }

    // Adds light by sampling emitters. Returns the importance of all emitters at the hit if one of them is chosen by it
    // (infinity: none gives light), or 0 if each of them is sampled.
    double take_samples(std::uint32_t i, const Hit& hit, const Scattering& surface) {
        const std::size_t count = in_.emitters_.size();
        if (count == 0) return 0;
        const Sampler& sampler = m_.uses[i].sampler;
        if (depth_ == 0 && count <= max_all_lights) {
            for (std::size_t e = 0; e < count; ++e)
                take_sample(i, hit, surface, e, 1, place_on(i, e, light_places + std::uint32_t(e)));
            return 0;
        }
        const double importance = in_.emitters_.importance(hit.position);
        if (!(importance > 0) || !std::isfinite(importance)) return infinity;
        const double at = count > 1 ? sampler.line(dimension(m_.paths[i], chosen_light)) : 0.5;
        if (const auto chosen = in_.emitters_.choose(hit.position, importance, at)) {
            const double part = in_.emitters_.importance(*chosen, hit.position);
            take_sample(i, hit, surface, *chosen, part / importance, place_on(i, *chosen, light_places));
        }
        return importance;
    }

    // The place on an emitter that is sampled, in the unit square.
    Vec2 place_on(std::uint32_t i, std::size_t emitter, std::uint32_t draw) const {
        return in_.emitters_.single(emitter) ? Vec2(0.5) : m_.uses[i].sampler.square(dimension(m_.paths[i], draw));
    }

    // Samples one emitter; `times` is the expected number of samples of this emitter.
    void take_sample(std::uint32_t i, const Hit& hit, const Scattering& surface, std::size_t emitter, double times,
                     Vec2 u) {
        const Emitters::Sample light = in_.emitters_.at(emitter, hit.position, u);
        if (!(max_component(light.irradiance) > 0)) return;
        const Scattering::Value value = surface.value(light.direction);
        if (!(max_component(value.value) > 0)) return;
        const bool single = light.density == infinity;
        const double weight = single ? 1 / times : 1 / (times + value.density / light.density);
        Path& path = m_.paths[i];
        Vec3 color = path.throughput * value.value * light.irradiance * weight;
        const Ray ray = leave(hit, light.direction);
        if (light.solid >= 0) {
            path.color += color * straight_.emission(light.solid, ray, emitter);
            return;
        }
        if (in_.emitters_.hidden(ray, light.distance, emitter)) return;
        if (in_.glass_ && (single || !in_.scene_.caustics)) {
            path.color += color * straight_.transmittance(ray, light.distance);
            return;
        }
        m_.shadow_rays.push_back(ray);
        m_.shadow_ends.push_back(light.distance);
        m_.shadows.push_back({color, i});
    }

    // Continues the path in a sampled direction; false if it ends.
    bool go_on(Path& path, const Sampler& sampler, const Hit& hit, const Scattering& surface, double importance,
               double first_choice) {
        Scattering::Sample next;
        const double choice = surface.is_choice(first_choice) ? sampler.line(dimension(path, lobe)) : 0.5;
        if (!surface.sample(first_choice + choice, sampler.square(dimension(path, lobe_direction)), next)) return false;
        path.throughput *= next.weight;
        const double left = max_component(path.throughput);
        if (!(left > 0) || !std::isfinite(left)) return false;
        if (depth_ + 1 >= first_roulette) {
            const double survival =
                std::clamp(survival_factor * left, min_survival, depth_ + 1 > last_certain ? max_late_survival : 1.0);
            if (survival < 1) {
                if (sampler.line(dimension(path, roulette)) >= survival) return false;
                path.throughput /= survival;
            }
        }
        path.ray = leave(hit, next.direction);
        path.density = next.density;
        if (next.density < infinity) {
            path.from = hit.position;
            path.importance = importance;
            path.diffused = true;
            path.over_glass = false;
            if (!in_.scene_.caustics) path.blur = std::max(path.blur, blur_after(next.alpha));
        }
        path.over_glass = path.over_glass || next.glass;
        return true;
    }

    const PathIntegrator& in_;
    const StraightTransmission straight_;
    PixelSums* sums_;
    LayerSums* layers_;
    TraceCounters& counters_;
    Memory& m_;
    int depth_ = 0;
    std::size_t rays_ = 0;  // number of camera paths, which precede those split from them
};

}  // namespace deburr
