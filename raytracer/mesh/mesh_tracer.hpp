// Traces rays against a mesh through Embree 3 or 4, with smooth normals.
//
// Embree works in single precision and is only asked which triangle is hit, and where in it; position and distance of
// the hit are then computed in double precision. A ray from far away is restarted near the mesh, so that single
// precision is that of the mesh's coordinates.
#pragma once
#include <memory>

#include "polygonizer/mesh/mesh.hpp"
#include "raytracer/trace/ray_tracer.hpp"

namespace deburr {

/// Traces a mesh. Queries are thread-safe.
class MeshTracer final : public RayTracer {
public:
    /// Takes the mesh, whose triangles name their solid and material. Rays are most exact in and around `near`. Throws
    /// UnsupportedError if Embree cannot be loaded, WorkError if memory is lacking.
    explicit MeshTracer(Mesh mesh, const Box& near = {});
    ~MeshTracer() override;
    Hit closest_hit(const Ray& ray, double t_max, TraceCounters& counters) const override;
    bool any_hit(const Ray& ray, double t_max, TraceCounters& counters) const override;

private:
    struct Embree;
    double start(const Ray& ray) const;

    Mesh mesh_;
    Vec3 middle_{0.0};   // center of a ball around the mesh
    double radius_ = 0;  // of that ball
    std::unique_ptr<Embree> embree_;
};

}  // namespace deburr
