// A path from the camera, on its way, and the surfaces that it meets: what the integrator's own files share.
#pragma once
#include <algorithm>

#include "raytracer/render/integrator.hpp"

namespace deburr {

// What a path draws random numbers for, at each depth; and once, for its way through the filter.
enum Purpose : std::uint32_t { choice, turn, layer_turn, first_light, purposes = 1024 };
constexpr std::uint32_t lens = 0xffffffffu;

inline double brightest(Vec3 c) { return std::max({c.x, c.y, c.z}); }
inline bool finite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
inline Vec3 finite_or_zero(Vec3 v) { return finite(v) ? v : Vec3(0.0); }

struct Integrator::Path {
    const Sampler& sampler;
    TraceCounters& counters;
    int depth = 0;               // rays since the camera's
    double weight = 1.0;         // bound of its share in the pixel, kept where glass forks
    bool without_noise = false;  // see "one sample" in the header
    bool scattered = false;      // by a base
    bool sees_lights = false;    // it was reflected last
    double density = infinity;   // of that reflection, per solid angle
    double blur = 0.0;           // least α of the highlights that it sees

    std::uint32_t dimension(std::uint32_t purpose) const { return std::uint32_t(depth) * purposes + purpose; }
    Path on(double share = 1.0) const {
        Path p = *this;
        ++p.depth;
        p.weight *= share;
        return p;
    }
    // An area light in a mirror that a base sees is left out, as point lights are of necessity.
    Path reflected(double with_density, double share = 1.0) const {
        Path p = on(share);
        p.sees_lights = !scattered;
        p.density = with_density;
        return p;
    }
};

// An opaque surface, as a path meets it; `color_here`: the material's at the hit. Keeps a reference to the hit.
struct Integrator::Surface {
    Surface(const Integrator& in, const Hit& hit, Vec3 color_here, Vec3 direction, const Path& path);

    const Hit& hit;
    Bsdf bsdf;
    bool last;          // no ray goes on to be sampled
    bool both = false;  // layer and base are both followed
    double base = 0.0;  // what the base returns, at most
    double layer_share =
        0.0;  // probability with which the layer's reflection is sampled too; 0: light is found here only
};

}  // namespace deburr
