// Materials, textures, lights, skies and framings in scenes.
#include "raytracer/scene/frame_camera.hpp"
#include "raytracer/scene/scene_functions.hpp"

namespace deburr {
namespace {

constexpr int max_shadow_rays = 4096;
constexpr int max_octaves = 10;
constexpr double largest_ior = 10;  // diamond has 2.4

// The only argument; an empty table if it is missing.
const LuaValue& fields_argument(const SceneCall& call) {
    static const LuaValue no_fields = std::make_shared<const LuaTable>();
    call.at_most(1);
    return call.arguments.empty() ? no_fields : call.arguments[0];
}

void read_color(const Fields& fields, const char* name, Vec3& value, double most) {
    if (const LuaValue* given = fields.find(name)) value = color(*given, fields.location(name), most);
}

void read_vector(const Fields& fields, const char* name, Vec3& value) {
    if (const LuaValue* given = fields.find(name)) value = vector(*given, fields.location(name));
}

void read_texture(const Fields& fields, Texture& texture) {
    const LuaValue* given = fields.find("color");
    if (!given) return;
    if (const SceneObject* object = as_object(*given)) {
        const auto* pattern = as<Texture>(object);
        if (!pattern) expected(fields.location("color"), "a colour or a texture", *given);
        texture = *pattern;
    } else {
        texture.a = color(*given, fields.location("color"), 1);
    }
}

// Reads a number from 0 to 1, or a texture, whose mean becomes the number (for an image, once it is read).
void read_share(const Fields& fields, const char* name, double& share, std::shared_ptr<const Texture>& texture) {
    const LuaValue* given = fields.find(name);
    if (!given) return;
    const SceneObject* object = as_object(*given);
    const auto* pattern = as<Texture>(object);
    if (pattern) {
        texture = std::make_shared<const Texture>(*pattern);
        const Vec3 sum = pattern->a + pattern->b;
        share = (sum.x + sum.y + sum.z) / 6;
        return;
    }
    if (object) expected(fields.location(name), "a number from 0 to 1 or a texture", *given);
    share = number_between(*given, fields.location(name), 0, 1);
}

void read_bump(const Fields& fields, Material& m) {
    const LuaValue* given = fields.find("bump");
    const LuaValue* height = fields.find("bump_height");
    if (given) {
        const auto* pattern = as<Texture>(as_object(*given));
        if (!pattern) expected(fields.location("bump"), "a texture", *given);
        m.bump = std::make_shared<const Texture>(*pattern);
    }
    if (!height) return;
    m.bump_height = number(*height, fields.location("bump_height"));
    if (!given) throw BadValue(fields.location("bump_height"), "expected a bump beside it, got none");
}

// The colour of materials that reflect or refract light is only a tint, and defaults to white.
const Texture untinted{.a = Vec3(1), .b = Vec3(1)};

void read_share(const Fields& fields, const char* name, double& share) {
    if (const auto* given = fields.find(name)) share = number_between(*given, fields.location(name), 0, 1);
}

void read_emission(const Fields& fields, Material& m) { read_color(fields, "emission", m.emission, infinity); }

SceneResult matte(SceneCall& call) {
    const Fields fields(fields_argument(call), call.name, {"color", "emission", "bump", "bump_height"});
    Material m;
    read_texture(fields, m.color);
    read_bump(fields, m);
    read_emission(fields, m);
    return call.make(m);
}

SceneResult plastic(SceneCall& call) {
    const Fields fields(fields_argument(call), call.name,
                        {"color", "roughness", "ior", "emission", "bump", "bump_height"});
    Material m{Material::Kind::plastic, {}, 0.2, 1.5};
    read_texture(fields, m.color);
    read_bump(fields, m);
    read_share(fields, "roughness", m.roughness, m.roughness_texture);
    read_emission(fields, m);
    if (const auto* given = fields.find("ior")) m.ior = number_between(*given, fields.location("ior"), 1, largest_ior);
    return call.make(m);
}

SceneResult metal(SceneCall& call) {
    const Fields fields(fields_argument(call), call.name, {"color", "roughness", "emission", "bump", "bump_height"});
    Material m{Material::Kind::metal, {}, 0.2, 1.5};
    read_texture(fields, m.color);
    read_bump(fields, m);
    read_share(fields, "roughness", m.roughness, m.roughness_texture);
    read_emission(fields, m);
    return call.make(m);
}

SceneResult mirror_material(SceneCall& call) {
    const Fields fields(fields_argument(call), call.name, {"color", "bump", "bump_height"});
    Material m{Material::Kind::mirror, untinted, 0, 1.5};
    read_texture(fields, m.color);
    read_bump(fields, m);
    return call.make(m);
}

SceneResult glass(SceneCall& call) {
    const Fields fields(fields_argument(call), call.name, {"color", "roughness", "ior", "bump", "bump_height"});
    Material m{Material::Kind::glass, untinted, 0, 1.5};
    read_texture(fields, m.color);
    read_bump(fields, m);
    read_share(fields, "roughness", m.roughness, m.roughness_texture);
    if (const auto* given = fields.find("ior")) m.ior = number_between(*given, fields.location("ior"), 1, largest_ior);
    return call.make(m);
}

SceneResult pbr(SceneCall& call) {
    const Fields fields(fields_argument(call), call.name,
                        {"color", "metallic", "roughness", "ior", "transmission", "clearcoat", "clearcoat_roughness",
                         "emission", "bump", "bump_height"});
    Material m{Material::Kind::pbr, {}, 0.5, 1.5};
    read_texture(fields, m.color);
    read_bump(fields, m);
    read_share(fields, "metallic", m.metallic, m.metallic_texture);
    read_share(fields, "roughness", m.roughness, m.roughness_texture);
    if (const auto* given = fields.find("ior")) m.ior = number_between(*given, fields.location("ior"), 1, largest_ior);
    read_share(fields, "transmission", m.transmission);
    read_share(fields, "clearcoat", m.clearcoat);
    read_share(fields, "clearcoat_roughness", m.clearcoat_roughness);
    read_emission(fields, m);
    return call.make(m);
}

void read_pattern(const Fields& fields, Texture& texture) {
    read_color(fields, "a", texture.a, 1);
    read_color(fields, "b", texture.b, 1);
    if (const auto* given = fields.find("scale")) texture.scale = number_above(*given, fields.location("scale"), 0);
    read_vector(fields, "origin", texture.origin);
}

void read_axis(const Fields& fields, Texture& texture) {
    if (const auto* given = fields.find("axis")) texture.axis = direction(*given, fields.location("axis"));
}

SceneResult checker(SceneCall& call) {
    const Fields fields(fields_argument(call), call.name, {"a", "b", "scale", "origin"});
    Texture texture;
    texture.kind = Texture::Kind::checker;
    read_pattern(fields, texture);
    return call.make(texture);
}

SceneResult wood(SceneCall& call) {
    const Fields fields(fields_argument(call), call.name, {"a", "b", "scale", "axis", "origin"});
    Texture texture;
    texture.kind = Texture::Kind::wood;
    texture.a = {0.72, 0.48, 0.27};
    texture.b = {0.45, 0.25, 0.12};
    read_pattern(fields, texture);
    read_axis(fields, texture);
    return call.make(texture);
}

SceneResult marble(SceneCall& call) {
    const Fields fields(fields_argument(call), call.name, {"a", "b", "scale", "axis", "origin", "turbulence"});
    Texture texture;
    texture.kind = Texture::Kind::marble;
    texture.a = {0.86, 0.84, 0.8};
    texture.b = {0.3, 0.29, 0.31};
    read_pattern(fields, texture);
    read_axis(fields, texture);
    if (const auto* given = fields.find("turbulence"))
        texture.turbulence = number_at_least(*given, fields.location("turbulence"), 0);
    return call.make(texture);
}

// Textures for factors and heights rather than colours.
Texture black_to_white(Texture::Kind kind) { return {.kind = kind, .a = Vec3(0), .b = Vec3(1)}; }

SceneResult noise_texture(SceneCall& call) {
    const Fields fields(fields_argument(call), call.name, {"a", "b", "scale", "origin", "octaves"});
    Texture texture = black_to_white(Texture::Kind::noise);
    read_pattern(fields, texture);
    if (const auto* given = fields.find("octaves"))
        texture.octaves = integer(*given, fields.location("octaves"), 1, max_octaves);
    return call.make(texture);
}

SceneResult brushed(SceneCall& call) {
    const Fields fields(fields_argument(call), call.name, {"a", "b", "scale", "axis", "origin", "around"});
    Texture texture = black_to_white(Texture::Kind::brushed);
    read_pattern(fields, texture);
    read_axis(fields, texture);
    if (const auto* given = fields.find("around")) texture.around = boolean(*given, fields.location("around"));
    return call.make(texture);
}

// The path of a picture in the scene's folder; throws BadValue if there is none.
std::string picture_file(const SceneCall& call, const Fields& fields) {
    const std::string& name = text(fields.get("file"), fields.location("file"));
    try {
        return call.builder.path_of(name);
    } catch (const std::runtime_error& error) {
        throw BadValue(fields.location("file"), error.what());
    }
}

SceneResult image_map(SceneCall& call) {
    const Fields fields(fields_argument(call), call.name, {"file", "scale", "rotate", "origin", "blend"});
    Texture texture;
    texture.kind = Texture::Kind::image;
    texture.b = texture.a;
    read_pattern(fields, texture);
    if (const auto* given = fields.find("rotate")) texture.rotate = number(*given, fields.location("rotate"));
    if (const auto* given = fields.find("blend"))
        texture.blend = number_between(*given, fields.location("blend"), 0, 1);
    texture.file = picture_file(call, fields);
    return call.make(texture);
}

void read_power(const Fields& fields, Light& light) {
    read_color(fields, "color", light.color, infinity);
    if (const auto* given = fields.find("power")) light.power = number_at_least(*given, fields.location("power"), 0);
}

void read_extended(const Fields& fields, Light& light) {
    if (const auto* given = fields.find("samples"))
        light.samples = integer(*given, fields.location("samples"), 1, max_shadow_rays);
    if (const auto* given = fields.find("visible")) light.visible = boolean(*given, fields.location("visible"));
    read_power(fields, light);
}

SceneResult point_light(SceneCall& call) {
    const Fields fields(fields_argument(call), call.name, {"position", "color", "power"});
    Light light;
    light.position = vector(fields.get("position"), fields.location("position"));
    read_power(fields, light);
    return call.make(light);
}

SceneResult directional_light(SceneCall& call) {
    const Fields fields(fields_argument(call), call.name, {"direction", "color", "power"});
    Light light;
    light.kind = Light::Kind::directional;
    light.direction = direction(fields.get("direction"), fields.location("direction"));
    read_power(fields, light);
    return call.make(light);
}

SceneResult area_light(SceneCall& call) {
    const Fields fields(fields_argument(call), call.name,
                        {"position", "u", "v", "color", "power", "samples", "visible"});
    Light light;
    light.kind = Light::Kind::area;
    light.position = vector(fields.get("position"), fields.location("position"));
    light.u = vector(fields.get("u"), fields.location("u"));
    light.v = vector(fields.get("v"), fields.location("v"));
    const double area = glm::length(glm::cross(light.u, light.v));
    if (!(area > 0 && std::isfinite(area)))
        throw BadValue(fields.location("v"),
                       "expected a side that spans an area with u, got " + described(fields.get("v")));
    read_extended(fields, light);
    return call.make(light);
}

SceneResult sphere_light(SceneCall& call) {
    const Fields fields(fields_argument(call), call.name,
                        {"position", "radius", "color", "power", "samples", "visible"});
    Light light;
    light.kind = Light::Kind::sphere;
    light.position = vector(fields.get("position"), fields.location("position"));
    light.radius = number_above(fields.get("radius"), fields.location("radius"), 0);
    read_extended(fields, light);
    return call.make(light);
}

void read_scale(const Fields& fields, Background& background) {
    if (const auto* given = fields.find("scale"))
        background.scale = number_at_least(*given, fields.location("scale"), 0);
}

SceneResult sky(SceneCall& call) {
    const Fields fields(fields_argument(call), call.name,
                        {"horizon", "zenith", "sun", "turbidity", "sun_size", "scale"});
    Background background;
    background.sky = true;
    read_color(fields, "horizon", background.horizon, infinity);
    read_color(fields, "zenith", background.zenith, infinity);
    if (const auto* given = fields.find("sun")) background.sun = direction(*given, fields.location("sun"));
    if (const auto* given = fields.find("turbidity"))
        background.turbidity = number_between(*given, fields.location("turbidity"), 2, 10);
    if (const auto* given = fields.find("sun_size"))
        background.sun_size = number_between(*given, fields.location("sun_size"), 0.1, 30);
    read_scale(fields, background);
    if (background.by_day()) return call.make(background);
    for (const char* name : {"turbidity", "sun_size", "scale"})
        if (fields.find(name)) throw BadValue(fields.location(name), "expected a sun beside it, got none");
    return call.make(background);
}

SceneResult environment(SceneCall& call) {
    const Fields fields(fields_argument(call), call.name, {"file", "scale", "rotate"});
    Background background;
    read_scale(fields, background);
    if (const auto* given = fields.find("rotate")) background.rotate = number(*given, fields.location("rotate"));
    background.file = picture_file(call, fields);
    return call.make(background);
}

SceneResult frame(SceneCall& call) {
    const Fields fields(fields_argument(call), call.name, {"from", "fov"});
    Framing framing = default_framing(call.builder.z_up);
    if (const auto* given = fields.find("from"))
        framing.from = direction(*given, fields.location("from"));
    else
        call.builder.up_mattered = true;
    if (const auto* given = fields.find("fov")) framing.fov = view_angle(*given, fields.location("fov"));
    return call.make(framing);
}

}  // namespace

const std::vector<SceneFunction>& material_functions() {
    using Kind = SceneFunction::Kind;
    static const std::vector<SceneFunction> functions = {
        {Kind::global, "matte", "", matte},
        {Kind::global, "plastic", "", plastic},
        {Kind::global, "metal", "", metal},
        {Kind::global, "mirror", "", mirror_material},
        {Kind::global, "glass", "", glass},
        {Kind::global, "pbr", "", pbr},
        {Kind::global, "checker", "", checker},
        {Kind::global, "wood", "", wood},
        {Kind::global, "marble", "", marble},
        {Kind::global, "noise", "", noise_texture},
        {Kind::global, "brushed", "", brushed},
        {Kind::global, "image_map", "", image_map},
        {Kind::global, "point_light", "", point_light},
        {Kind::global, "directional_light", "", directional_light},
        {Kind::global, "area_light", "", area_light},
        {Kind::global, "sphere_light", "", sphere_light},
        {Kind::global, "sky", "", sky},
        {Kind::global, "environment", "", environment},
        {Kind::global, "frame", "", frame},
    };
    return functions;
}

}  // namespace deburr
