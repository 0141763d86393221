// How surfaces scatter light for the path integrator: every material, from both sides, without loss.
//
// A surface is a weighted sum of four parts, as glTF mixes them [glTF 2.0, appendix B]:
//
//   base     diffuse, below a dielectric layer; and what a metal reflects more than once
//   layer    a GGX reflection, dielectric or metallic (bsdf.hpp)
//   glass    a GGX boundary that reflects and refracts [Walter et al. 2007]
//   coat     a clear layer of index 1.5 over all of them
//
// Nothing is lost. What a layer does not reflect at once goes to the base, in the form that keeps reciprocity
// [Kelemen & Szirmay-Kalos 2001; Kulla & Conty 2017]. Glass is divided by its own albedo [Turquin, Practical
// multiple scattering compensation for microfacet models, 2019], and a coat lets pass to what is below it all that it
// does not reflect towards the eye: both are right in energy from every side, and not reciprocal.
//
// The radiance in a denser medium is not scaled by its squared index: light seen from outside has left it again.
#pragma once
#include <map>
#include <memory>
#include <tuple>

#include "raytracer/render/albedo_table.hpp"
#include "raytracer/render/bsdf.hpp"

namespace deburr {

/// Tables that materials share.
class AlbedoTables {
public:
    const AlbedoTable* get(AlbedoTable::Kind kind, double alpha, double ior);

private:
    std::map<std::tuple<AlbedoTable::Kind, double, double>, std::unique_ptr<AlbedoTable>> tables_;
};

/// What all points of a material have in common. Keeps pointers into the tables.
struct ScatteringMaterial {
    ScatteringMaterial() = default;
    /// Layers are no sharper than `min_alpha`, unless there is glass: as a diffuse surface may see them, which finds
    /// their highlights too seldom.
    ScatteringMaterial(const Material& material, AlbedoTables& tables, double min_alpha = 0);

    /// The same material with another share of metal, where it was made with one between 0 and 1.
    void set_metallic(double metallic);

    Material::Kind kind = Material::Kind::matte;
    double ior = 1.5, transmission = 0.0;
    double metal = 0.0, dielectric = 0.0, glass = 0.0;  // shares, of sum 1
    double coat = 0.0;
    Ggx ggx, coat_ggx;
    bool smooth = false, coat_smooth = false;  // mirrors
    // Null where they are not needed.
    const AlbedoTable *white = nullptr, *boundary = nullptr, *entering = nullptr, *leaving = nullptr,
                      *coating = nullptr;
};

/// A material at one point, as seen from one direction. Directions are unit and lead away from the surface.
class Scattering {
public:
    /// `outward` is the unit normal out of the solid; `color` the material's at the point. Keeps a reference to
    /// `material`.
    Scattering(const ScatteringMaterial& material, Vec3 color, Vec3 outward, Vec3 to_eye);
    /// Shaded with a normal that is not the surface's, but on the eye's side, too (bump.hpp). No light goes to the
    /// other side of the surface on the same side of the normal, nor the other way round: some is lost there.
    Scattering(const ScatteringMaterial& material, Vec3 color, Vec3 shading, Vec3 outward, Vec3 to_eye);

    struct Value {
        Vec3 value{0.0};       // times the cosine of the direction
        double density = 0.0;  // per solid angle, with which sample() finds it
    };
    /// Value and density of what the material scatters there, but for mirrors, whose value is 0.
    Value value(Vec3 direction) const;

    struct Sample {
        Vec3 direction{0.0}, weight{0.0};  // weight: value / density
        double density = infinity;         // infinity: a mirror's only direction
        double alpha = 0.0;                // of the facets; 1 for a base
        bool glass = false;                // by glass
        bool passes = false;               // to the other side
    };
    /// False if the light is lost. `choice` and `u` are uniform in [0, 1), but for split().
    bool sample(double choice, Vec2 u, Sample& sample) const;

    /// Whether sample() depends on its choice between `first`, 0 or 1, and first + 1.
    bool is_choice(double first) const {
        return p_glass_ > 0 || (first == 0 ? p_base_ < 1 && p_layer_ < 1 && p_coat_ < 1 : p_layer_ < 1 && p_coat_ < 1);
    }

    /// Where there is a base below something else, or glass alone: from now on, both of two are sampled, the one by a
    /// choice from 0 to 1 and the other by one from 1 to 2, and densities count both. They are the base and the rest,
    /// or what glass reflects and what passes. False, and nothing changes, where there is no such pair.
    bool split();

    /// Whether value() is ever more than 0.
    bool diffuses() const { return diffuses_; }
    /// Share of the light of a uniformly white world that the base returns.
    Vec3 base_albedo() const { return below_coat_ * (dielectric_base_ * kept_ + metal_base_ * metal_kept_); }
    Vec3 normal() const { return normal_; }

private:
    Vec3 base(double cosine) const;
    // Whether the surface is between the eye and a direction where the normal says that it is not, or the reverse.
    bool shines_through(Vec3 direction, double cosine) const {
        return bumped_ && (glm::dot(surface_normal_, direction) > 0) != (cosine > 0);
    }
    Vec3 layer_fresnel(double cosine) const;
    double coat_fresnel(double cosine) const { return fresnel_dielectric(cosine, coat_ior); }
    struct GlassChoice {
        double back, through;  // probabilities that glass reflects, and lets pass, where it is sampled
    };
    GlassChoice glass_choice(double fresnel) const;
    bool sample_glass(double choice, Vec2 u, Sample& sample) const;
    bool sample_lobe(double choice, Vec2 u, Sample& sample) const;
    static constexpr double coat_ior = 1.5;

    const ScatteringMaterial& m_;
    Vec3 color_, normal_, to_eye_;
    Vec3 surface_normal_{0.0};  // on the eye's side, where bumped
    bool inside_;
    bool bumped_ = false;
    double ior_;  // of the far side over that of the near one
    double cos_eye_;
    double below_coat_ = 1.0, coat_ = 0.0;
    double kept_ = 1.0, metal_kept_ = 0.0;                                // 1 − albedo of the layer, towards the eye
    Vec3 dielectric_base_{0.0}, metal_base_{0.0};                         // colours of the bases
    double glass_scale_ = 1.0;                                            // 1 / albedo
    double p_base_ = 0.0, p_layer_ = 0.0, p_glass_ = 0.0, p_coat_ = 0.0;  // of being sampled
    bool diffuses_ = false;
    bool both_ways_ = false;  // glass is split
};

}  // namespace deburr
