// Colour of a pixel: camera rays, lights, materials.
//
// Every random number is a function of (seed, pixel, sample, dimension), so a pixel's value depends
// on neither threads, tiles nor crop.
#pragma once
#include <cstdint>

#include "raytracer/film.hpp"
#include "raytracer/ray_tracer.hpp"
#include "raytracer/scene.hpp"

namespace deburr {

struct RenderSettings {
    int width = 0, height = 0;  // of the whole picture
    int spp = 1;                // 1: one ray through the pixel's centre
    std::uint64_t seed = 0;
};

/// Ray through a point of the picture, in pixels: (x + ½, y + ½) is the centre of pixel (x, y).
class PinholeCamera {
public:
    PinholeCamera(const Camera& camera, int width, int height);
    Ray ray(double x, double y) const;
    Vec3 forward() const { return forward_; }
    Vec3 eye() const { return eye_; }

private:
    Vec3 eye_, forward_, corner_, dx_, dy_;
};

class Integrator {
public:
    /// Keeps references to both.
    Integrator(const Scene& scene, const RayTracer& tracer, RenderSettings settings);
    Pixel pixel(int x, int y, TraceCounters& counters) const;

private:
    const Scene& scene_;
    const RayTracer& tracer_;
    RenderSettings settings_;
    PinholeCamera camera_;
};

}  // namespace deburr
