// A path from the camera, on its way, and the surfaces that it meets: what the integrator's own files share.
#pragma once
#include <algorithm>

#include "raytracer/render/integrator.hpp"

namespace deburr {

// What a path draws random numbers for, at each depth; and once, for its way through the filter.
enum Purpose : std::uint32_t { first_light = 3, purposes = 1024 };
constexpr std::uint32_t lens = 0xffffffffu;

inline double brightest(Vec3 c) { return std::max({c.x, c.y, c.z}); }
inline bool finite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
inline Vec3 finite_or_zero(Vec3 v) { return finite(v) ? v : Vec3(0.0); }

struct Integrator::Path {
    const Sampler& sampler;
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

// An opaque surface, as a path meets it; `color_here`: the material's at the hit. Keeps a reference to the hit.
struct Integrator::Surface {
    Surface(const Integrator& in, const Hit& hit, Vec3 color_here, Vec3 direction);

    const Hit& hit;
    Bsdf bsdf;
    Vec3 emission;
};

}  // namespace deburr
