// What shading asks of geometry: the nearest surface along a ray, by whichever road it is found
// (implicit, implicit_tracer.hpp; or a mesh in Embree).
#pragma once
#include <cstdint>
#include <span>

#include "raytracer/simd/ray_packet.hpp"

namespace deburr {

struct Hit {
    double t = infinity;  // distance along the ray; infinity: nothing was hit
    Vec3 position{0.0};
    Vec3 normal{0.0};     // unit, out of the solid (it may point along the ray: we are inside)
    int solid = -1;       // index in Scene::solids
    int material = 0;     // index in Scene::materials
    double offset = 0.0;  // how far along ±normal a new ray must start to leave this surface

    explicit operator bool() const { return t < infinity; }
};

/// Counts of work done while tracing; each thread has its own and they are added up.
struct TraceCounters {
    std::uint64_t rays = 0, shadow_rays = 0, instances = 0, cells = 0, flat_hits = 0;
    std::uint64_t segments = 0, splits = 0, evaluations = 0;

    TraceCounters& operator+=(const TraceCounters& o);
};

class RayTracer {
public:
    virtual ~RayTracer() = default;
    /// First surface at a distance in (0, t_max).
    virtual Hit closest_hit(const Ray& ray, double t_max, TraceCounters& counters) const = 0;
    /// Whether there is any surface at a distance in (0, t_max).
    virtual bool any_hit(const Ray& ray, double t_max, TraceCounters& counters) const = 0;

    /// The same for many rays, to the bit: the sooner the closer neighbours run to each other.
    virtual void closest_hits(std::span<const Ray> rays, Hit* hits, TraceCounters& counters) const;
    virtual void any_hits(std::span<const Ray> rays, std::span<const double> t_max, bool* occluded,
                          TraceCounters& counters) const;
};

/// The ray's origin lifted off the surface it was found on, to the side that `direction` leads to.
inline Ray leave(const Hit& hit, Vec3 direction) {
    const double side = glm::dot(hit.normal, direction) < 0 ? -1.0 : 1.0;
    return {hit.position + hit.normal * (side * hit.offset), direction};
}

}  // namespace deburr
