// A camera path and the surfaces that it meets; shared by the files that implement the integrator.
#pragma once
#include <algorithm>
#include <array>
#include <functional>

#include "raytracer/render/bump.hpp"
#include "raytracer/render/integrator.hpp"
#include "raytracer/render/surface_batch.hpp"

namespace deburr {

// The purposes for which a path draws random numbers at each depth; and, once, for the lens.
enum Purpose : std::uint32_t { first_light = 3, purposes = 1024 };
constexpr std::uint32_t lens = 0xffffffffu;

/// The state of a path from the camera.
struct Integrator::Path {
    Sampler sampler;
    TraceCounters& counters;
    int depth = 0;             // number of rays after the camera's
    double weight = 1.0;       // upper bound of its share in the pixel, while glass splits paths
    bool sees_lights = false;  // whether it was reflected last, so that it sees lights

    std::uint32_t dimension(std::uint32_t purpose) const { return std::uint32_t(depth) * purposes + purpose; }
    // The path after a further bounce that carries this share of its light.
    Path on(double share = 1.0) const {
        Path p = *this;
        ++p.depth;
        p.weight *= share;
        return p;
    }
    // The path after a reflection that carries this share of its light.
    Path reflected(double share = 1.0) const {
        Path p = on(share);
        p.sees_lights = true;
        return p;
    }
};

// A batch of opaque surfaces that are shaded together, with memory for shadow rays; it owns none of it.
struct Integrator::Surfaces {
    SurfaceBatch batch;
    const Hit** hits;
    // Shadow rays to one light, with the index of each ray's surface.
    Ray* shadows;
    double* t_max;
    std::uint32_t* shaded;
    bool* hidden;
};

// The memory for Surfaces.
template <std::size_t capacity>
struct Integrator::SurfaceRoom {
    std::size_t count = 0;  // of surfaces
    SurfaceArrays<capacity> arrays;
    std::array<const Hit*, capacity> hits;
    std::array<Ray, capacity> shadows;
    std::array<double, capacity> t_max;
    std::array<std::uint32_t, capacity> shaded;
    std::array<bool, capacity> hidden;

    Surfaces surfaces() {
        return {arrays.batch(count), hits.data(), shadows.data(), t_max.data(), shaded.data(), hidden.data()};
    }
};

template <std::size_t capacity>
inline void Integrator::add(SurfaceRoom<capacity>& room, const Hit& hit, Vec3 color_here, Vec3 direction) const {
    const std::size_t i = room.count++;
    room.hits[i] = &hit;
    const SurfaceBatch batch = room.arrays.batch(0);
    const Material& here = material(hit);
    batch.layer[i] = hit.material;
    batch.set(SurfaceField::position, i, hit.position);
    batch.set(SurfaceField::normal, i,
              here.bump ? shading_normal(here, hit.position, hit.normal, -direction) : hit.normal);
    batch.set(SurfaceField::to_eye, i, -direction);
    batch.set(SurfaceField::color, i, color_here);
}

}  // namespace deburr
