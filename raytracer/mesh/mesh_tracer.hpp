// The polygonal road: rays against a mesh, through Embree 3 or 4, with smooth normals.
//
// Embree works in single precision. It only says which triangle and where in it; the hit's position
// and distance are then computed from the mesh in double precision. A ray from far away is handed to it
// from where it comes near the mesh, so that single precision is that of the mesh's coordinates.
#pragma once
#include <memory>

#include "polygonizer/mesh/mesh.hpp"
#include "raytracer/trace/ray_tracer.hpp"

namespace deburr {

class MeshTracer final : public RayTracer {
public:
    /// Triangles say which solid and material they are. Rays are most exact in and around `near`.
    explicit MeshTracer(Mesh mesh, const Box& near = {});
    ~MeshTracer() override;
    Hit closest_hit(const Ray& ray, double t_max, TraceCounters& counters) const override;
    bool any_hit(const Ray& ray, double t_max, TraceCounters& counters) const override;

private:
    struct Embree;
    double start(const Ray& ray) const;

    Mesh mesh_;
    Vec3 middle_{0.0};   // of the ball around the mesh
    double radius_ = 0;  // of that ball
    std::unique_ptr<Embree> embree_;
};

}  // namespace deburr
