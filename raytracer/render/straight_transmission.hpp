// Light that passes glass straight on, without refraction: an approximation that path_integrator.hpp describes. Part of
// the implementation of path_integrator.cpp.
#pragma once
#include "raytracer/render/path_integrator.hpp"
#include "raytracer/render/textures.hpp"

namespace deburr {

// Most glass surfaces that light passes straight through; it is lost at further ones.
inline constexpr int max_glass_passed = 16;

/// Follows rays that are sent from a surface to an emitter. It keeps references to the integrator and the counters.
class PathIntegrator::StraightTransmission {
public:
    StraightTransmission(const PathIntegrator& integrator, TraceCounters& counters)
        : in_(integrator), counters_(counters) {}

    /// The share of light that passes straight through all glass on the ray's first `left` units; 0 if anything else is
    /// in the way.
    Vec3 transmittance(Ray ray, double left) const {
        Vec3 share(1.0);
        for (int k = 0; k < max_glass_passed; ++k) {
            const Hit hit = in_.tracer_.closest_hit(ray, left, counters_);
            if (!hit) return share;
            share *= passed_by(hit, ray.direction);
            if (!(max_component(share) > 0)) break;
            left -= hit.t;
            ray = leave(hit, ray.direction);
        }
        return Vec3(0.0);
    }

    /// The light of a glowing solid that a ray sent to it finds, where `emitter` is the solid's number among the
    /// emitters. Unless the scene has caustics, the light passes glass on its way.
    Vec3 emission(int solid, Ray ray, std::size_t emitter) const {
        Vec3 share(1.0);
        for (int k = 0; k < max_glass_passed; ++k) {
            const Hit hit = in_.tracer_.closest_hit(ray, infinity, counters_);
            if (!hit || in_.emitters_.hidden(ray, hit.t, emitter)) break;
            const Vec3 emission = in_.scene_.materials[hit.material].emission;
            if (hit.solid == solid && max_component(emission) > 0)
                return glm::dot(hit.normal, ray.direction) < 0 ? share * emission : Vec3(0.0);
            if (in_.scene_.caustics) break;
            share *= passed_by(hit, ray.direction);
            if (!(max_component(share) > 0)) break;
            ray = leave(hit, ray.direction);
        }
        return Vec3(0.0);
    }

private:
    // The share of light that passes straight through the surface.
    Vec3 passed_by(const Hit& hit, Vec3 direction) const {
        const Material& m = in_.scene_.materials[hit.material];
        if (!in_.lets_light_pass(m)) return Vec3(0.0);
        const double metal = m.metallic_texture ? value_at(*m.metallic_texture, hit.position, hit.normal) : m.metallic;
        const double passed = m.kind == Material::Kind::glass ? 1.0 : (1 - metal) * m.transmission;
        return color_at(m.color, hit.position, hit.normal) *
               (passed * (1 - fresnel_dielectric(glm::dot(hit.normal, direction), m.ior)));
    }

    const PathIntegrator& in_;
    TraceCounters& counters_;
};

}  // namespace deburr
