// Spheres, planes and slabs intersected by formulas, so that shading is tested without the ray tracer's BVH.
#pragma once
#include <functional>
#include <numbers>
#include <vector>

#include "raytracer/render/integrator.hpp"

namespace deburr {

struct AnalyticShape {
    enum class Kind { sphere, plane, slab } kind = Kind::sphere;
    Vec3 at{0.0};          // center of a sphere; a point on a plane
    Vec3 normal{0, 1, 0};  // of a plane or slab; a slab lies between `at` and at − size·normal
    double size = 1.0;     // radius of a sphere; thickness of a slab
    int material = 0;
};

/// The horizontal plane at this height.
inline AnalyticShape floor_at(double y, int material = 0) {
    return {AnalyticShape::Kind::plane, {0, y, 0}, {0, 1, 0}, 0, material};
}

inline const AnalyticShape unit_sphere{AnalyticShape::Kind::sphere, Vec3(0.0), {}, 1, 0};

class AnalyticTracer final : public RayTracer {
public:
    explicit AnalyticTracer(std::vector<AnalyticShape> shapes) : shapes_(std::move(shapes)) {}

    Hit closest_hit(const Ray& ray, double t_max, TraceCounters& counters) const override {
        ++counters.rays;
        return nearest(ray, t_max, counters);
    }
    bool any_hit(const Ray& ray, double t_max, TraceCounters& counters) const override {
        ++counters.shadow_rays;
        return bool(nearest(ray, t_max, counters));
    }

private:
    Hit nearest(const Ray& ray, double t_max, TraceCounters& counters) const {
        ++counters.evaluations;
        Hit hit;
        hit.t = t_max;
        bool any = false;
        auto take = [&](double t, std::size_t i, Vec3 normal) {
            if (!(t > 0 && t < hit.t)) return;
            any = true;
            hit.t = t;
            hit.position = ray.origin + t * ray.direction;
            hit.normal = normal;
            hit.solid = int(i);
            hit.material = shapes_[i].material;
            hit.offset = 1e-9;
        };
        for (std::size_t i = 0; i < shapes_.size(); ++i) {
            const AnalyticShape& s = shapes_[i];
            if (s.kind == AnalyticShape::Kind::sphere) {
                const Vec3 o = ray.origin - s.at;
                const double b = glm::dot(o, ray.direction), c = glm::dot(o, o) - s.size * s.size;
                if (b * b < c) continue;
                const double root = std::sqrt(b * b - c);
                for (double t : {-b - root, -b + root}) take(t, i, (o + t * ray.direction) / s.size);
                continue;
            }
            const double slope = glm::dot(ray.direction, s.normal);
            if (slope == 0) continue;
            const double t = glm::dot(s.at - ray.origin, s.normal) / slope;
            take(t, i, s.normal);
            if (s.kind == AnalyticShape::Kind::slab) take(t - s.size / slope, i, -s.normal);
        }
        if (!any) hit.t = infinity;
        return hit;
    }
    std::vector<AnalyticShape> shapes_;
};

inline bool close(Vec3 a, Vec3 b, double tolerance) { return glm::length(a - b) <= tolerance; }

inline Texture plain_texture(Vec3 color) {
    Texture t;
    t.a = color;
    return t;
}
inline Texture plain_texture(double grey) { return plain_texture(Vec3(grey)); }

inline Material material_of(Material::Kind kind, Vec3 color, double roughness = 0.2, double ior = 1.5) {
    return {kind, plain_texture(color), roughness, ior};
}

/// A scene of one pixel that looks along −y at the origin; the field of view is so narrow that all samples see one
/// point.
inline Scene probe(Material material) {
    Scene scene;
    scene.camera = {{0, 4, 0}, {0, 0, 0}, {0, 0, -1}, 1e-7};
    scene.materials = {std::move(material)};
    return scene;
}

inline Pixel pixel_of(const Scene& scene, const RayTracer& tracer, int spp, std::uint64_t seed = 0) {
    TraceCounters counters;
    return Integrator(scene, tracer, {1, 1, spp, seed}).pixel(0, 0, nullptr, counters);
}

}  // namespace deburr
