// Rays through one BSP.
#pragma once
#include "bounds/root_finder.hpp"
#include "raytracer/bsp_tree.hpp"
#include "raytracer/ray_tracer.hpp"

namespace deburr {

struct FoundSurface {
    SurfaceCrossing crossing;  // t = infinity: none
    int solid = -1;            // as the BSP numbers them
    double error = 0;          // of the position: what floating point rounds it by
};

/// First crossing along the ray in [0, t_max]; with `any`, of some solid.
FoundSurface find_surface(const BspTree& tree, Criterion criterion, const Ray& ray, double t_max, bool any,
                          TraceCounters& counters);

}  // namespace deburr
