#include "raytracer/scene/scene_descriptions.hpp"

#include <fmt/format.h>

#include <set>

#include "bounds/bounding_box.hpp"
#include "raytracer/scene/box_text.hpp"
#include "raytracer/util/printable.hpp"

namespace deburr {
namespace {

// Boxes of larger objects are left out, since computing them takes too long for a description.
constexpr double max_described_leaves = 5'000;

std::string text_of(double x) { return std::isfinite(x) ? fmt::format("{:.6g}", x + 0.0) : x > 0 ? "inf" : "-inf"; }

std::string text_of(Vec3 v) { return fmt::format("{{{}, {}, {}}}", text_of(v.x), text_of(v.y), text_of(v.z)); }

// A colour as scenes write it: one number for a grey.
std::string color_of(Vec3 c) { return c.x == c.y && c.y == c.z ? text_of(c.x) : text_of(c); }

std::string half_space_count(double half_spaces) {
    return fmt::format("{:.0f} half-space{}", half_spaces, half_spaces == 1 ? "" : "s");
}

// ", radius 0.1", or the least and greatest radius; "" if all is sharp.
std::string radii_of(const std::set<double>& radii) {
    if (radii.empty() || *radii.rbegin() == 0) return "";
    if (radii.size() == 1) return fmt::format(", radius {}", text_of(*radii.begin()));
    return fmt::format(", radii from {} to {}", text_of(*radii.begin()), text_of(*radii.rbegin()));
}

std::string describe(const Density& density) {
    std::string text = "density of " + half_space_count(density.node().leaves);
    if (density.node().leaves > max_described_leaves) return text;
    const DensityTree tree = flatten(density, 0);
    std::set<double> radii;
    for (const HalfSpace& h : tree.half_spaces) radii.insert(h.radius);
    return text + ", " + box_text(bounding_box(tree)) + radii_of(radii);
}

std::string describe(const Texture& t) {
    switch (t.kind) {
        case Texture::Kind::constant: return color_of(t.a);
        case Texture::Kind::checker:
            return fmt::format("checker{{ a = {}, b = {}, scale = {} }}", color_of(t.a), color_of(t.b),
                               text_of(t.scale));
        case Texture::Kind::wood:
            return fmt::format("wood{{ a = {}, b = {}, scale = {}, axis = {} }}", color_of(t.a), color_of(t.b),
                               text_of(t.scale), text_of(t.axis));
        case Texture::Kind::marble:
            return fmt::format("marble{{ a = {}, b = {}, scale = {}, axis = {}, turbulence = {} }}", color_of(t.a),
                               color_of(t.b), text_of(t.scale), text_of(t.axis), text_of(t.turbulence));
        case Texture::Kind::noise:
            return fmt::format("noise{{ a = {}, b = {}, scale = {}, octaves = {} }}", color_of(t.a), color_of(t.b),
                               text_of(t.scale), t.octaves);
        case Texture::Kind::brushed:
            return fmt::format("brushed{{ a = {}, b = {}, scale = {}, axis = {}, around = {} }}", color_of(t.a),
                               color_of(t.b), text_of(t.scale), text_of(t.axis), t.around);
        case Texture::Kind::image:
            return fmt::format("image_map{{ file = '{}', scale = {} }}", printable(t.file), text_of(t.scale));
    }
    return "texture";
}

std::string share_or_texture(double share, const Texture* texture) {
    return texture ? describe(*texture) : text_of(share);
}

std::string describe(const Material& m) {
    std::string text = fmt::format("{}{{ color = {}", name_of(m.kind), describe(m.color));
    if (m.kind != Material::Kind::matte && m.kind != Material::Kind::mirror)
        text += fmt::format(", roughness = {}", share_or_texture(m.roughness, m.roughness_texture.get()));
    if (m.kind == Material::Kind::pbr)
        text += fmt::format(", metallic = {}, transmission = {}, clearcoat = {}",
                            share_or_texture(m.metallic, m.metallic_texture.get()), text_of(m.transmission),
                            text_of(m.clearcoat));
    if (m.emission != Vec3(0.0)) text += fmt::format(", emission = {}", color_of(m.emission));
    if (m.kind == Material::Kind::plastic || m.kind == Material::Kind::glass || m.kind == Material::Kind::pbr)
        text += fmt::format(", ior = {}", text_of(m.ior));
    if (m.bump) text += fmt::format(", bump = {}, bump_height = {}", describe(*m.bump), text_of(m.bump_height));
    return text + " }";
}

std::string describe(const Solid& solid) {
    std::string text = "solid of " + half_space_count(solid.node().leaves);
    if (solid.node().leaves > max_described_leaves) return text;
    const SolidTree tree = flatten(solid);
    std::set<double> radii;
    double half_spaces = 0;
    bool fields = false;
    for (const SolidLeaf& leaf : tree.leaves) {
        half_spaces += double(leaf.density.half_spaces.size());
        fields |= leaf.field != nullptr;
        for (const HalfSpace& h : leaf.density.half_spaces) radii.insert(h.radius);
    }
    text = fields ? half_spaces > 0 ? "solid of " + half_space_count(half_spaces) + " and smooth surfaces"
                                    : "solid, smooth"
                  : "solid of " + half_space_count(half_spaces);
    return text + ", " + box_text(bounding_box(tree)) + radii_of(radii);
}

std::string describe(const Quadric& q) { return fmt::format("quadric, {}", box_text(FreeForm(q, {}).bounding_box())); }

std::string describe(const Perturbation& p) {
    return fmt::format("perturbation by {} in {}", text_of(p.factor), box_text(FreeForm(p.quadric, {}).bounding_box()));
}

std::string describe(const Light& light) {
    const std::string shine = fmt::format("color = {}, power = {} }}", color_of(light.color), text_of(light.power));
    switch (light.kind) {
        case Light::Kind::point: return fmt::format("point_light{{ position = {}, {}", text_of(light.position), shine);
        case Light::Kind::directional:
            return fmt::format("directional_light{{ direction = {}, {}", text_of(light.direction), shine);
        case Light::Kind::area:
            return fmt::format("area_light{{ position = {}, u = {}, v = {}, {}", text_of(light.position),
                               text_of(light.u), text_of(light.v), shine);
        case Light::Kind::sphere:
            return fmt::format("sphere_light{{ position = {}, radius = {}, {}", text_of(light.position),
                               text_of(light.radius), shine);
    }
    return "light";
}

std::string describe(const Background& b) {
    if (!b.file.empty()) return fmt::format("environment{{ file = '{}' }}", printable(b.file));
    if (b.by_day()) return fmt::format("sky{{ sun = {}, turbidity = {} }}", text_of(b.sun), text_of(b.turbidity));
    return fmt::format("sky{{ horizon = {}, zenith = {} }}", color_of(b.horizon), color_of(b.zenith));
}

std::string describe(const Framing& f) {
    return fmt::format("frame{{ from = {}, fov = {} }}", text_of(f.from), text_of(f.fov));
}

std::string describe(const PlacedModel& m) { return fmt::format("model '{}'", printable(m.file)); }

}  // namespace

const char* name_of(Material::Kind kind) {
    switch (kind) {
        case Material::Kind::matte: return "matte";
        case Material::Kind::plastic: return "plastic";
        case Material::Kind::metal: return "metal";
        case Material::Kind::mirror: return "mirror";
        case Material::Kind::glass: return "glass";
        case Material::Kind::pbr: return "pbr";
    }
    return "material";
}

double work_to_describe(const SceneObject& object) {
    const auto* density = as<Density>(&object);
    const auto* solid = as<Solid>(&object);
    const double leaves = density ? density->node().leaves : solid ? solid->node().leaves : 1;
    return leaves > max_described_leaves ? 1 : leaves;
}

std::string description(const SceneObject& object) {
    std::string text;
    const auto take = [&]<class T>(const T* it) {
        if (it) text = describe(*it);
    };
    take(as<Density>(&object));
    take(as<Solid>(&object));
    take(as<Quadric>(&object));
    take(as<Perturbation>(&object));
    take(as<Material>(&object));
    take(as<Light>(&object));
    take(as<Texture>(&object));
    take(as<Background>(&object));
    take(as<Framing>(&object));
    take(as<PlacedModel>(&object));
    if (text.empty()) return kind_of(object);
    return object.name ? fmt::format("'{}': {}", printable(*object.name), text) : text;
}

}  // namespace deburr
