// How surfaces scatter light in previews, and what the path integrator's materials (scattering.hpp) share with that.
// Matte, plastic, metal and mirror are a layer over a base, evaluated by the kernels of shading_kernels.hpp; glass
// follows Fresnel's and Snell's laws in the integrator.
//
// The layer is a GGX microfacet surface [Walter et al. 2007] with Smith's height-correlated masking [Heitz 2014],
// sampled (by paths) by its visible normals [Dupuy & Benyoub 2023]. A plastic's layer reflects by Fresnel's equations,
// a metal's by Schlick's approximation with its colour as F0. The light that the layer does not reflect at once, 1 − E
// where E is its directional albedo, goes to the base, which scatters it in the form that keeps reciprocity [Kelemen &
// Szirmay-Kalos 2001]
//
//     base · (1 − E(in)) (1 − E(out)) / (π (1 − E_mean))
//
// For plastic, base is its colour. For metal, where E is that of a white metal, it is the light reflected more than
// once between facets [Kulla & Conty 2017]. Either way a white material in a white furnace is invisible. Matte is a
// base without a layer, and mirror a smooth layer tinted by its colour.
#pragma once
#include <array>
#include <span>

#include "raytracer/render/sampler.hpp"
#include "raytracer/scene/scene.hpp"

namespace deburr {

/// A layer with a GGX α below this is smooth: a perfect mirror without highlights of point and directional lights,
/// which would be smaller than a pixel and pure noise.
constexpr double smooth_alpha = 0.0025;

/// The share of unpolarized light that a smooth boundary reflects. `ior` is the index of the far side over that of the
/// near side. 1 at total internal reflection.
double fresnel_dielectric(double cosine, double ior);
/// Schlick's approximation of the reflectance, with `f0` at normal incidence.
Vec3 fresnel_schlick(Vec3 f0, double cosine);

/// The mirrored direction. `to_eye` is unit, leads away from the surface, and is on the side of the unit `normal`.
Vec3 reflected(Vec3 to_eye, Vec3 normal);
/// Sets the refracted direction; false at total internal reflection. Arguments as for reflected() and
/// fresnel_dielectric().
bool refracted(Vec3 to_eye, Vec3 normal, double ior, Vec3& direction);

/// A cosine-distributed direction around a unit normal, for a uniform `u` in the unit square.
Vec3 cosine_direction(Vec3 normal, Vec2 u);

/// The GGX microfacet distribution around a normal; directions are given by their cosines to it.
struct Ggx {
    double alpha = 0.04;

    /// The density D of facet normals per solid angle.
    double distribution(double cos_half) const;
    /// G2 / G1(out), the weight of a sampled reflection besides Fresnel's.
    double shadowing(double cos_in, double cos_out) const;
    /// The density per solid angle of reflections about sampled facets.
    double density(double cos_out, double cos_half) const;
    /// A facet's normal, distributed as the facets that `to_eye` sees.
    Vec3 facet(Vec3 to_eye, Vec3 normal, Vec2 u) const;
    /// facet() in coordinates where the normal is z, for the cosine and sine of 2π u.y (`turn`) and for
    /// stretched(to_eye). The visible normals of a hemisphere are halfway between `to_eye` and a point of a uniform
    /// spherical cap; those of GGX are the ones of a stretched hemisphere.
    Vec3 facet_about_z(Vec3 stretched_eye, double u, Vec2 turn) const {
        const double z = (1 - u) * (1 + stretched_eye.z) - stretched_eye.z;
        const double r = std::sqrt(glm::clamp(1 - z * z, 0.0, 1.0));
        const Vec3 half = Vec3(r * turn.x, r * turn.y, z) + stretched_eye;
        const Vec3 facet(alpha * half.x, alpha * half.y, std::max(0.0, half.z));
        const double length = glm::length(facet);
        return length > 0 ? facet / length : Vec3(0, 0, 1);
    }
    Vec3 stretched(Vec3 to_eye) const { return glm::normalize(Vec3(alpha * to_eye.x, alpha * to_eye.y, to_eye.z)); }
};

/// The material's kind in previews: for a pbr material, the other kind that it resembles most.
Material::Kind preview_kind(const Material& material);

/// The layer and base of a material, the same at all its points.
class SurfaceLayer {
public:
    explicit SurfaceLayer(const Material& material);
    /// Whether two materials have the same layer, which is expensive to make.
    static bool same(const Material& a, const Material& b);

    Material::Kind kind() const { return kind_; }
    bool smooth() const { return smooth_; }
    const Ggx& ggx() const { return ggx_; }
    double ior() const { return ior_; }
    /// The layer's directional albedo E (metal, mirror: of a white one), and its cosine-weighted mean.
    double albedo(double cosine) const;
    double mean_albedo() const { return mean_; }
    /// 1/(π (1 − E_mean)), for the light that the layer transmits; 0 if there is none.
    double base_share() const { return base_share_; }
    /// Whether its reflection is traced like a mirror's.
    bool polished() const;
    /// α of its reflection, at most 1.
    double blur() const { return smooth_ ? 0.0 : std::min(1.0, ggx_.alpha); }

    /// albedo() at the cosines (i / n)², i = 0 … n.
    std::span<const double> albedo_table() const { return albedo_; }

private:
    double integrate(double cosine) const;
    static constexpr int steps = 32;
    Material::Kind kind_;
    bool smooth_;
    Ggx ggx_;
    double ior_;
    double mean_ = 0.0, base_share_ = 0.0;
    std::array<double, steps + 1> albedo_{};  // at cosine (i / steps)²
};

}  // namespace deburr
