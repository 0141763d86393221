#include "raytracer/render/scattering.hpp"

#include <algorithm>
#include <numbers>

namespace deburr {
namespace {

// Least cosine at a shading point, since masking is 0/0 at 0.
constexpr double min_eye_cosine = 1e-5;
// A boundary between indices this close does not refract, and a half vector then says nothing about its facets.
constexpr double min_ior_step = 1e-3;
// Least probability of sampling a part that exists; otherwise a dim part would be noisy.
constexpr double min_part = 0.1;

}  // namespace

const AlbedoTable* AlbedoTables::get(AlbedoTable::Kind kind, double alpha, double ior) {
    auto& table = tables_[{kind, alpha, ior}];
    if (!table) table = std::make_unique<AlbedoTable>(kind, alpha, ior);
    return table.get();
}

ScatteringMaterial::ScatteringMaterial(const Material& material, AlbedoTables& tables, double min_alpha)
    : kind(material.kind), ior(material.ior), ggx{material.roughness * material.roughness} {
    using Kind = Material::Kind;
    switch (kind) {
        case Kind::matte: dielectric = 1; break;
        case Kind::plastic: dielectric = 1; break;
        case Kind::metal: metal = 1; break;
        case Kind::mirror: metal = 1; break;
        case Kind::glass: glass = 1; break;
        case Kind::pbr:
            transmission = material.transmission;
            // With a texture, all parts exist, so that all tables are made.
            set_metallic(material.metallic_texture ? 0.5 : material.metallic);
            coat = material.clearcoat;
            break;
    }
    if (kind == Kind::mirror) ggx.alpha = 0;
    if (glass > 0) min_alpha = 0;
    ggx.alpha = std::max(ggx.alpha, min_alpha);
    smooth = !(ggx.alpha >= smooth_alpha);
    if (glass > 0 && std::abs(ior - 1) < min_ior_step) smooth = true;
    if (smooth) ggx.alpha = 0;
    if (metal > 0) white = tables.get(AlbedoTable::Kind::white, ggx.alpha, 0);
    if (dielectric > 0 && kind != Kind::matte) boundary = tables.get(AlbedoTable::Kind::boundary, ggx.alpha, ior);
    if (glass > 0) {
        entering = tables.get(AlbedoTable::Kind::both, ggx.alpha, ior);
        leaving = tables.get(AlbedoTable::Kind::both, ggx.alpha, 1 / ior);
    }
    if (coat > 0) {
        coat_ggx.alpha = std::max(min_alpha, material.clearcoat_roughness * material.clearcoat_roughness);
        coat_smooth = !(coat_ggx.alpha >= smooth_alpha);
        coating = tables.get(AlbedoTable::Kind::boundary, coat_smooth ? 0 : coat_ggx.alpha, 1.5);
    }
}

void ScatteringMaterial::set_metallic(double metallic) {
    metal = metallic;
    glass = (1 - metal) * transmission;
    dielectric = (1 - metal) * (1 - transmission);
}

Scattering::Scattering(const ScatteringMaterial& material, Vec3 color, Vec3 shading, Vec3 outward, Vec3 to_eye)
    : Scattering(material, color, shading, to_eye) {
    bumped_ = shading != outward;
    surface_normal_ = glm::dot(outward, to_eye) < 0 ? -outward : outward;
}

Scattering::Scattering(const ScatteringMaterial& material, Vec3 color, Vec3 outward, Vec3 to_eye)
    : m_(material), color_(color), to_eye_(to_eye), inside_(glm::dot(outward, to_eye) < 0) {
    normal_ = inside_ ? -outward : outward;
    ior_ = inside_ ? 1 / m_.ior : m_.ior;
    cos_eye_ = std::max(glm::dot(normal_, to_eye), min_eye_cosine);
    if (m_.coat > 0 && !inside_) {
        coat_ = m_.coat;
        below_coat_ = 1 - coat_ * m_.coating->at(cos_eye_);
    }
    double layer = 0;
    if (m_.dielectric > 0) {
        const double e = m_.boundary ? m_.boundary->at(cos_eye_) : 0.0;
        kept_ = 1 - e;
        dielectric_base_ = m_.dielectric * color;
        layer += m_.dielectric * e;
    }
    if (m_.metal > 0) {
        const double e = m_.white->at(cos_eye_), mean = m_.white->mean();
        metal_kept_ = 1 - e;
        if (mean < 1) {
            // Light that leaves after one, two, … further reflections, each with the mean Fresnel reflectance.
            const Vec3 f = m_.kind == Material::Kind::mirror ? color : color + (1.0 - color) / 21.0;
            metal_base_ = m_.metal * f * f * mean / (1.0 - f * (1 - mean));
        }
        layer +=
            m_.metal * e * max_component(m_.kind == Material::Kind::mirror ? color : fresnel_schlick(color, cos_eye_));
    }
    if (m_.glass > 0) glass_scale_ = 1 / (inside_ ? m_.leaving : m_.entering)->at(cos_eye_);
    const Vec3 base = base_albedo();

    const auto share = [](double part) { return part > 0 ? std::max(part, min_part) : 0.0; };
    p_base_ = share(max_component(base));
    p_layer_ = share(below_coat_ * layer);
    p_glass_ = share(below_coat_ * m_.glass);
    p_coat_ = share(1 - below_coat_);
    const double sum = p_base_ + p_layer_ + p_glass_ + p_coat_;
    if (sum > 0) {
        p_base_ /= sum;
        p_layer_ /= sum;
        p_glass_ /= sum;
        p_coat_ /= sum;
    }
    diffuses_ = p_base_ > 0 || (!m_.smooth && p_layer_ + p_glass_ > 0) || (!m_.coat_smooth && p_coat_ > 0);
}

bool Scattering::split() {
    const double rest = p_layer_ + p_glass_ + p_coat_;
    if (!(rest > 0)) return false;
    if (p_glass_ == 1) return both_ways_ = true;
    if (!(p_base_ > 0)) return false;
    p_base_ = 1;
    p_layer_ /= rest;
    p_glass_ /= rest;
    p_coat_ /= rest;
    return true;
}

// The base's value without the coat and the cosine.
Vec3 Scattering::base(double cosine) const {
    using std::numbers::inv_pi;
    Vec3 sum(0.0);
    if (m_.dielectric > 0)
        sum += m_.boundary ? dielectric_base_ * (m_.boundary->base_share() * kept_ * (1 - m_.boundary->at(cosine)))
                           : dielectric_base_ * inv_pi;
    if (m_.metal > 0 && m_.white->mean() < 1)
        sum += metal_base_ * (m_.white->base_share() * metal_kept_ * (1 - m_.white->at(cosine)));
    return sum;
}

Vec3 Scattering::layer_fresnel(double cosine) const {
    if (m_.kind == Material::Kind::mirror) return color_;
    Vec3 sum(0.0);
    if (m_.dielectric > 0 && m_.boundary) sum += m_.dielectric * fresnel_dielectric(cosine, m_.ior);
    if (m_.metal > 0) sum += m_.metal * fresnel_schlick(color_, cosine);
    return sum;
}

Scattering::GlassChoice Scattering::glass_choice(double fresnel) const {
    if (both_ways_) return {1, 1};
    const double back = fresnel / (fresnel + (1 - fresnel) * std::max(max_component(color_), 0.01));
    return {back, 1 - back};
}

Scattering::Value Scattering::value(Vec3 l) const {
    Value v;
    const double cosine = glm::dot(normal_, l);
    if (shines_through(l, cosine)) return v;
    const bool rough_layer = p_layer_ > 0 && !m_.smooth, rough_glass = p_glass_ > 0 && !m_.smooth;
    const bool rough_coat = p_coat_ > 0 && !m_.coat_smooth;
    if (cosine > 0) {
        if (p_base_ > 0) {
            v.value += base(cosine) * (below_coat_ * cosine);
            v.density += p_base_ * cosine * std::numbers::inv_pi;
        }
        if (!rough_layer && !rough_glass && !rough_coat) return v;
        const Vec3 half = glm::normalize(to_eye_ + l);
        const double cos_half = glm::dot(half, normal_), cos_facet = glm::dot(half, l);
        if (rough_layer || rough_glass) {
            const double density = m_.ggx.density(cos_eye_, cos_half), passed = m_.ggx.shadowing(cosine, cos_eye_);
            if (rough_layer) {
                v.value += layer_fresnel(cos_facet) * (below_coat_ * density * passed);
                v.density += p_layer_ * density;
            }
            if (rough_glass) {
                const double f = fresnel_dielectric(cos_facet, ior_);
                v.value += Vec3(m_.glass * below_coat_ * glass_scale_ * f * density * passed);
                v.density += p_glass_ * glass_choice(f).back * density;
            }
        }
        if (rough_coat) {
            const double density = m_.coat_ggx.density(cos_eye_, cos_half);
            v.value += Vec3(coat_ * coat_fresnel(cos_facet) * density * m_.coat_ggx.shadowing(cosine, cos_eye_));
            v.density += p_coat_ * density;
        }
        return v;
    }
    if (!(cosine < 0) || !rough_glass) return v;
    // The facet that refracts one direction into the other, and the Jacobian of its solid angle [Walter et al. 2007,
    // eq. 16 and 17].
    Vec3 facet = to_eye_ + ior_ * l;
    if (glm::dot(facet, normal_) < 0) facet = -facet;
    facet = glm::normalize(facet);
    const double cos_in = glm::dot(to_eye_, facet), cos_out = -glm::dot(l, facet);
    if (!(cos_in > 0 && cos_out > 0)) return v;
    const double root = cos_in - ior_ * cos_out;
    if (root == 0) return v;
    const double stretch = ior_ * ior_ * cos_out / (root * root);
    const double density = m_.ggx.density(cos_eye_, glm::dot(facet, normal_)) * 4 * cos_in * stretch;
    const double f = fresnel_dielectric(cos_in, ior_);
    v.value =
        color_ * (m_.glass * below_coat_ * glass_scale_ * (1 - f) * density * m_.ggx.shadowing(-cosine, cos_eye_));
    v.density = p_glass_ * glass_choice(f).through * density;
    return v;
}

// Samples glass; false if no light goes that way. For rough glass, only the direction is set.
bool Scattering::sample_glass(double choice, Vec2 u, Sample& s) const {
    const Vec3 facet = m_.smooth ? normal_ : m_.ggx.facet(to_eye_, normal_, u);
    Vec3 through(0.0);
    const bool can_pass = refracted(to_eye_, facet, ior_, through);
    const double f = can_pass ? fresnel_dielectric(glm::dot(to_eye_, facet), ior_) : 1.0;
    const auto [back, pass] = glass_choice(f);
    s.passes = choice >= back;
    if (s.passes && !can_pass) return false;
    s.direction = s.passes ? through : glm::normalize(reflected(to_eye_, facet));
    if (!m_.smooth) return true;
    const double scale = m_.glass * below_coat_ / p_glass_;
    s.weight = s.passes ? color_ * (scale * (1 - f) / pass) : Vec3(scale * f / back);
    return true;
}

// Samples base, layer or coat; false if the direction is on the wrong side. The weight is set for mirrors only.
bool Scattering::sample_lobe(double choice, Vec2 u, Sample& s) const {
    const auto reflect = [&](const Ggx& ggx, bool smooth) {
        s.direction = glm::normalize(reflected(to_eye_, smooth ? normal_ : ggx.facet(to_eye_, normal_, u)));
        s.density = smooth ? infinity : 0.0;
        s.alpha = ggx.alpha;
    };
    if (choice < p_base_) {
        s.direction = cosine_direction(normal_, u);
        s.density = 0;
        s.alpha = 1;
        return true;
    }
    choice -= p_base_;
    if (choice < p_layer_) {
        reflect(m_.ggx, m_.smooth);
        if (m_.smooth) s.weight = layer_fresnel(cos_eye_) * (below_coat_ / p_layer_);
        return true;
    }
    choice -= p_layer_;
    if (choice < p_coat_) {
        reflect(m_.coat_ggx, m_.coat_smooth);
        if (m_.coat_smooth) s.weight = Vec3(coat_ * coat_fresnel(cos_eye_) / p_coat_);
        return true;
    }
    choice -= p_coat_;
    if (!(p_glass_ > 0)) return false;
    s.density = m_.smooth ? infinity : 0.0;
    s.alpha = m_.ggx.alpha;
    s.glass = true;
    return sample_glass(both_ways_ ? choice : std::min(choice / p_glass_, 1 - epsilon), u, s);
}

bool Scattering::sample(double choice, Vec2 u, Sample& s) const {
    s = {};
    if (!sample_lobe(choice, u, s)) return false;
    const double cosine = glm::dot(s.direction, normal_);
    if (s.passes ? !(cosine < 0) : !(cosine > 0)) return false;
    if (shines_through(s.direction, cosine)) return false;
    if (s.density == infinity) return true;
    const Value v = value(s.direction);
    if (!(v.density > 0)) return false;
    s.weight = v.value / v.density;
    s.density = v.density;
    return true;
}

}  // namespace deburr
