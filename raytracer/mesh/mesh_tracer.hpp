// The polygonal road: rays against a mesh, through Embree 3 or 4, with smooth normals.
//
// Embree works in single precision. It only says which triangle and where in it; the hit's position
// and distance are then computed from the mesh in double precision.
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
    Hit first_hit(const Ray& ray, double t_max, TraceCounters& counters) const override;
    bool occluded(const Ray& ray, double t_max, TraceCounters& counters) const override;

private:
    struct Embree;
    Mesh mesh_;
    std::unique_ptr<Embree> embree_;
};

}  // namespace deburr
