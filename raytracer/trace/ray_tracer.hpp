// The interface between shading and geometry: surfaces along rays, whether they are found in implicit solids
// (implicit_tracer.hpp) or in a mesh (mesh_tracer.hpp).
#pragma once
#include <cstdint>
#include <span>

#include "raytracer/simd/ray_packet.hpp"

namespace deburr {

/// The nearest surface along a ray.
struct Hit {
    double t = infinity;  // distance along the ray; infinity: nothing was hit
    Vec3 position{0.0};
    Vec3 normal{0.0};     // unit, out of the solid; it points along the ray where the ray leaves the solid
    int solid = -1;       // index in Scene::solids
    int material = 0;     // index in Scene::materials
    double offset = 0.0;  // distance along ±normal at which a new ray must start to leave this surface

    explicit operator bool() const { return t < infinity; }
};

/// Work done while tracing; each thread has its own counters, which are added up at the end.
///
///   rays, shadow_rays   closest-hit and any-hit queries
///   instances           entries of a ray into an instance
///   cells               intersections of a ray with a cell primitive
///   flat_hits           crossings that were found as a plane's
///   segments, splits    segments of rays that root searches examined, and that they halved
///   evaluations         evaluations of a density or field on a ray
struct TraceCounters {
    std::uint64_t rays = 0, shadow_rays = 0, instances = 0, cells = 0, flat_hits = 0;
    std::uint64_t segments = 0, splits = 0, evaluations = 0;

    TraceCounters& operator+=(const TraceCounters& o);
};

/// Finds surfaces along rays. Queries are thread-safe; `counters` belongs to the calling thread.
class RayTracer {
public:
    virtual ~RayTracer() = default;
    /// The first surface at a distance in (0, t_max); its t is infinity if there is none.
    virtual Hit closest_hit(const Ray& ray, double t_max, TraceCounters& counters) const = 0;
    /// Whether there is a surface at a distance in (0, t_max).
    virtual bool any_hit(const Ray& ray, double t_max, TraceCounters& counters) const = 0;

    /// closest_hit() without a limit and any_hit() for many rays, with the same results to the bit; faster if rays next
    /// to each other in the list are close to each other. `hits`, `t_max` and `occluded` have an element for each ray.
    virtual void closest_hits(std::span<const Ray> rays, Hit* hits, TraceCounters& counters) const;
    virtual void any_hits(std::span<const Ray> rays, std::span<const double> t_max, bool* occluded,
                          TraceCounters& counters) const;
};

/// A ray in `direction` from the surface that was hit, its origin lifted off on the side that it leads to.
inline Ray leave(const Hit& hit, Vec3 direction) {
    const double side = glm::dot(hit.normal, direction) < 0 ? -1.0 : 1.0;
    return {hit.position + hit.normal * (side * hit.offset), direction};
}

}  // namespace deburr
