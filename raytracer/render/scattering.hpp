// How surfaces scatter light for the path integrator: all materials, from both sides, without loss of energy.
//
// A surface is a weighted sum of four parts, mixed as in glTF [glTF 2.0, appendix B]:
//
//   base     diffuse, below a dielectric layer; or the multiple reflection of a metal
//   layer    a GGX reflection, dielectric or metallic (bsdf.hpp)
//   glass    a GGX boundary that reflects and refracts [Walter et al. 2007]
//   coat     a clear layer of index 1.5 over all of them
//
// No energy is lost. The light that a layer does not reflect at once goes to the base, in the form that keeps
// reciprocity [Kelemen & Szirmay-Kalos 2001; Kulla & Conty 2017]. Glass is divided by its own albedo [Turquin,
// Practical multiple scattering compensation for microfacet models, 2019], and a coat transmits all light that it does
// not reflect towards the eye; both conserve energy from every side, but are not reciprocal.
//
// The radiance in a denser medium is not scaled by the square of its index, since light that is seen from outside has
// left it again.
#pragma once
#include <map>
#include <memory>
#include <tuple>

#include "raytracer/render/albedo_table.hpp"
#include "raytracer/render/bsdf.hpp"

namespace deburr {

/// Albedo tables that materials share; each is made once.
class AlbedoTables {
public:
    /// The table for these parameters, which is made on the first call.
    const AlbedoTable* get(AlbedoTable::Kind kind, double alpha, double ior);

private:
    std::map<std::tuple<AlbedoTable::Kind, double, double>, std::unique_ptr<AlbedoTable>> tables_;
};

/// The parameters of a material, the same at all its points. Keeps pointers to the tables.
struct ScatteringMaterial {
    ScatteringMaterial() = default;
    /// Layers get at least the roughness `min_alpha` unless there is glass: for paths from diffuse surfaces, which find
    /// sharp highlights too rarely.
    ScatteringMaterial(const Material& material, AlbedoTables& tables, double min_alpha = 0);

    /// Changes the share of metal; the material must have been made with a share between 0 and 1.
    void set_metallic(double metallic);

    Material::Kind kind = Material::Kind::matte;
    double ior = 1.5, transmission = 0.0;
    double metal = 0.0, dielectric = 0.0, glass = 0.0;  // shares, whose sum is 1
    double coat = 0.0;
    Ggx ggx, coat_ggx;
    bool smooth = false, coat_smooth = false;  // whether they are mirrors
    // Null where they are not needed.
    const AlbedoTable *white = nullptr, *boundary = nullptr, *entering = nullptr, *leaving = nullptr,
                      *coating = nullptr;
};

/// A material at one point as seen from one direction. Directions are unit and lead away from the surface.
class Scattering {
public:
    /// `outward` is the unit normal, out of the solid; `color` is the material's at the point. Keeps a reference to
    /// `material`.
    Scattering(const ScatteringMaterial& material, Vec3 color, Vec3 outward, Vec3 to_eye);
    /// With a shading normal other than the surface's, but also on the eye's side (bump.hpp). Light that would cross
    /// the surface on one side of the shading normal, or the reverse, is blocked, which loses some energy.
    Scattering(const ScatteringMaterial& material, Vec3 color, Vec3 shading, Vec3 outward, Vec3 to_eye);

    /// The result of evaluating a direction.
    struct Value {
        Vec3 value{0.0};       // BSDF times the cosine of the direction
        double density = 0.0;  // of sample() for it, per solid angle
    };
    /// The value and density for light from `direction`, without mirrors.
    Value value(Vec3 direction) const;

    /// A sampled direction.
    struct Sample {
        Vec3 direction{0.0}, weight{0.0};  // weight: value / density
        double density = infinity;         // infinity: the only direction of a mirror
        double alpha = 0.0;                // of the facets; 1 for a base
        bool glass = false;                // scattered by glass
        bool passes = false;               // transmitted to the other side
    };
    /// Samples a direction for uniform `choice` and `u` in [0, 1) (after split(), see there). False if the light is
    /// lost.
    bool sample(double choice, Vec2 u, Sample& sample) const;

    /// Whether sample() depends on its choice between `first` (0 or 1) and first + 1.
    bool is_choice(double first) const {
        return p_glass_ > 0 || (first == 0 ? p_base_ < 1 && p_layer_ < 1 && p_coat_ < 1 : p_layer_ < 1 && p_coat_ < 1);
    }

    /// Splits a surface that has a base below something else, or is glass only: then two directions are sampled, one by
    /// a choice in [0, 1) and one by a choice in [1, 2), and densities are sums of both. They are those of the base and
    /// of the rest, or of reflection and transmission by glass. False, without any change, if there is no such pair.
    bool split();

    /// Whether value() can be more than 0.
    bool diffuses() const { return diffuses_; }
    /// Share of the light of a uniform white environment that the base returns.
    Vec3 base_albedo() const { return below_coat_ * (dielectric_base_ * kept_ + metal_base_ * metal_kept_); }
    Vec3 normal() const { return normal_; }

private:
    Vec3 base(double cosine) const;
    // Whether a direction is on the other side of the surface than the shading normal makes it seem.
    bool shines_through(Vec3 direction, double cosine) const {
        return bumped_ && (glm::dot(surface_normal_, direction) > 0) != (cosine > 0);
    }
    Vec3 layer_fresnel(double cosine) const;
    double coat_fresnel(double cosine) const { return fresnel_dielectric(cosine, coat_ior); }
    struct GlassChoice {
        double back, through;  // probabilities of reflection and transmission, when glass is sampled
    };
    GlassChoice glass_choice(double fresnel) const;
    bool sample_glass(double choice, Vec2 u, Sample& sample) const;
    bool sample_lobe(double choice, Vec2 u, Sample& sample) const;
    static constexpr double coat_ior = 1.5;

    const ScatteringMaterial& m_;
    Vec3 color_, normal_, to_eye_;
    Vec3 surface_normal_{0.0};  // on the eye's side, if bumped
    bool inside_;
    bool bumped_ = false;
    double ior_;  // index of the far side over that of the near side
    double cos_eye_;
    double below_coat_ = 1.0, coat_ = 0.0;
    // 1 − albedo of the layers, as seen from the eye
    double kept_ = 1.0, metal_kept_ = 0.0;
    Vec3 dielectric_base_{0.0}, metal_base_{0.0};                         // colours of the bases
    double glass_scale_ = 1.0;                                            // 1 / albedo
    double p_base_ = 0.0, p_layer_ = 0.0, p_glass_ = 0.0, p_coat_ = 0.0;  // probabilities of being sampled
    bool diffuses_ = false;
    bool both_ways_ = false;  // whether glass is split
};

}  // namespace deburr
