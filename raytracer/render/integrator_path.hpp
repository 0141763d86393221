// A path from the camera, on its way, and the surfaces that it meets: what the integrator's own files share.
#pragma once
#include <algorithm>
#include <array>
#include <functional>

#include "raytracer/render/bump.hpp"
#include "raytracer/render/integrator.hpp"
#include "raytracer/render/surface_batch.hpp"

namespace deburr {

// What a path draws random numbers for, at each depth; and once, for its way through the filter.
enum Purpose : std::uint32_t { first_light = 3, purposes = 1024 };
constexpr std::uint32_t lens = 0xffffffffu;

inline double brightest(Vec3 c) { return std::max({c.x, c.y, c.z}); }
inline bool finite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
inline Vec3 finite_or_zero(Vec3 v) { return finite(v) ? v : Vec3(0.0); }

struct Integrator::Path {
    Sampler sampler;
    TraceCounters& counters;
    int depth = 0;             // rays since the camera's
    double weight = 1.0;       // bound of its share in the pixel, kept where glass forks
    bool sees_lights = false;  // it was reflected last

    std::uint32_t dimension(std::uint32_t purpose) const { return std::uint32_t(depth) * purposes + purpose; }
    Path on(double share = 1.0) const {
        Path p = *this;
        ++p.depth;
        p.weight *= share;
        return p;
    }
    Path reflected(double share = 1.0) const {
        Path p = on(share);
        p.sees_lights = true;
        return p;
    }
};

// Opaque surfaces that are shaded together, and room for the rays that this takes. It owns none of them.
struct Integrator::Surfaces {
    SurfaceBatch batch;
    const Hit** hits;
    // To one light; each ray's surface.
    Ray* shadows;
    double* t_max;
    std::uint32_t* shaded;
    bool* hidden;
};

// Room for them.
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
