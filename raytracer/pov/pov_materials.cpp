#include "raytracer/pov/pov_materials.hpp"

#include <algorithm>
#include <array>

#include "raytracer/pov/pov_text.hpp"
#include "raytracer/render/bsdf.hpp"
#include "raytracer/render/integrator.hpp"
#include "raytracer/render/lights.hpp"

namespace deburr {
namespace {

// POV-Ray's light falls off as 2/(1 + (d/fade)²), which is 1/d² beyond a few `fade`. `fade` is this fraction of the
// distance from the light to the camera's target.
constexpr double fade_part = 1e-3;
// Least α of a highlight, as POV-Ray does not take sharper ones; at that, the highlight of a point light is about a
// pixel.
constexpr double min_alpha = 0.02;

// The transform that moves the x axis (or the z axis, if `from` is 'z') of a POV-Ray pattern to the texture's axis,
// with its origin and scale.
std::string placement(const Texture& t, char from) {
    const Vec3 axis = glm::normalize(t.axis);
    const Vec3 side = std::abs(axis.y) < 0.9 ? Vec3(0, 1, 0) : Vec3(0, 0, 1);
    const Vec3 across = glm::normalize(glm::cross(axis, side));
    const Vec3 away = glm::cross(axis, across);
    const auto [x, y, z] = from == 'z' ? std::array{across, away, axis} : std::array{axis, across, away};
    return fmt::format("scale {} matrix <{}, {}, {}, {}, {}, {}, {}, {}, {}, 0, 0, 0> translate {}", t.scale, x.x, x.y,
                       x.z, y.x, y.y, y.z, z.x, z.y, z.z, pov_vector(t.origin));
}

// Length of a streak in widths.
constexpr double streak_length = 100;

std::string pigment(const Texture& t) {
    switch (t.kind) {
        case Texture::Kind::checker:
            return fmt::format("pigment {{ checker {}, {} scale {} translate {} }}", pov_color(t.a), pov_color(t.b),
                               t.scale, pov_vector(t.origin));
        case Texture::Kind::wood:
            return fmt::format("pigment {{ wood turbulence 0.1 color_map {{ [0 {}] [0.9 {}] [1 {}] }} {} }}",
                               pov_color(t.a), pov_color(t.b), pov_color(t.a), placement(t, 'z'));
        case Texture::Kind::marble:
            return fmt::format("pigment {{ marble turbulence {} color_map {{ [0 {}] [0.7 {}] [1 {}] }} {} }}",
                               t.turbulence, pov_color(t.b), pov_color(t.a), pov_color(t.a), placement(t, 'x'));
        case Texture::Kind::noise:
            return fmt::format("pigment {{ {} color_map {{ [0 {}] [1 {}] }} scale {} translate {} }}",
                               t.octaves > 1 ? "granite" : "bumps", pov_color(t.a), pov_color(t.b), t.scale,
                               pov_vector(t.origin));
        case Texture::Kind::brushed:
            return fmt::format("pigment {{ bumps color_map {{ [0 {}] [1 {}] }} scale <1, 1, {}> {} }}", pov_color(t.a),
                               pov_color(t.b), t.around ? 1 : streak_length, placement(t, 'z'));
        case Texture::Kind::image: break;  // POV-Ray has no triplanar mapping, so the image's mean is used
        case Texture::Kind::constant: break;
    }
    return fmt::format("pigment {{ {} }}", pov_color(t.a));
}

// The peak of a GGX lobe of this α is 1/(4α²) times that of a white matte surface; Blinn's lobe of the same width has
// the exponent 2/α² − 2.
std::string highlight(double alpha, double f0) {
    alpha = std::max(alpha, min_alpha);
    return fmt::format("specular {} roughness {}", f0 / (4 * alpha * alpha),
                       1 / std::max(1.0, 2 / (alpha * alpha) - 2));
}

}  // namespace

std::string pov_settings(const Scene& scene, bool radiosity) {
    // Finer than POV-Ray's defaults, so that the error of its patches is only a percent or two.
    if (radiosity)
        return fmt::format(
            "global_settings {{\n  assumed_gamma 1.0 max_trace_level {} ambient_light 0\n  radiosity {{\n"
            "    pretrace_start 0.08 pretrace_end 0.005 count 400 nearest_count 10 error_bound 0.3\n"
            "    low_error_factor 0.5 recursion_limit 5 minimum_reuse 0.005 gray_threshold 0 brightness 1\n  }}\n}}\n",
            std::max(5, scene.bounces + 1));
    const SkyLight sky(scene.lighting());
    const Vec3 ambient = scene.ambient + sky.mean(scene.z_up ? Vec3(0, 0, 1) : Vec3(0, 1, 0));
    return fmt::format("global_settings {{ assumed_gamma 1.0 max_trace_level {} ambient_light {} }}\n",
                       std::max(2, scene.bounces + 1), pov_color(ambient));
}

std::string pov_camera(const Camera& camera, Size size) {
    // Computed from rays through three of the picture's corners, scaled to a common depth.
    const ProjectiveCamera view(camera, size.width, size.height);
    const auto at = [&](double x, double y) {
        const Ray ray = view.ray(x, y);
        if (camera.orthographic) return ray.origin;
        return ray.direction / glm::dot(ray.direction, view.forward());
    };
    const Vec3 corner = at(0, 0), right = at(size.width, 0) - corner, up = corner - at(0, size.height);
    const Vec3 middle = camera.shift.x * right + camera.shift.y * up;  // offset of the picture's middle from the axis
    const Vec3 location = camera.orthographic ? camera.eye + middle : camera.eye;
    const Vec3 direction = camera.orthographic ? view.forward() : view.forward() + middle;
    return fmt::format("camera {{\n  {}\n  location {}\n  direction {}\n  right {}\n  up {}\n}}\n",
                       camera.orthographic ? "orthographic" : "perspective", pov_vector(location),
                       pov_vector(direction), pov_vector(right), pov_vector(up));
}

std::string pov_background(const Background& b) {
    if (!b.sky) return fmt::format("background {{ {} }}\n", pov_color(b.color));
    return fmt::format("sky_sphere {{ pigment {{ function {{ sqrt(max(0, {})) }} color_map {{ [0 {}] [1 {}] }} }} }}\n",
                       b.z_up ? "z" : "y", pov_color(b.horizon), pov_color(b.zenith));
}

std::string pov_light(const Light& light, const Scene& scene) {
    const Vec3 target = scene.camera.target;
    // POV-Ray's diffuse reflection is the colour times the cosine, without the factor 1/π.
    const Vec3 color = light.color * light.power / pi;
    if (light.kind == Light::Kind::directional) {
        const Vec3 direction = glm::normalize(light.direction);
        const double far = 1e3 * std::max(1.0, glm::length(scene.camera.eye - target));
        return fmt::format("light_source {{ {}, {} parallel point_at {} }}\n", pov_vector(target - far * direction),
                           pov_color(color), pov_vector(target));
    }
    const double fade = fade_part * std::max(epsilon, glm::length(light.position - target));
    const double strength = 1 / (2 * fade * fade);
    const std::string falls = fmt::format("fade_distance {} fade_power 2", fade);
    if (light.kind == Light::Kind::point || light.kind == Light::Kind::sphere)
        return fmt::format("light_source {{ {}, {} {} }}\n", pov_vector(light.position),
                           pov_color(color * strength / (4 * pi)), falls);
    // A Lambertian emitter's intensity along its normal is power/π.
    const int side = std::max(1, int(std::lround(std::sqrt(light.samples))));
    return fmt::format("light_source {{ {}, {} area_light {}, {}, {}, {} {} }}\n", pov_vector(light.position),
                       pov_color(color * strength / pi), pov_vector(light.u), pov_vector(light.v), side, side, falls);
}

std::string pov_material(const Material& m) {
    const double alpha = m.roughness * m.roughness;
    const bool smooth = alpha < smooth_alpha;
    const double f0 = fresnel_dielectric(1.0, m.ior);
    std::string finish, interior, paint = pigment(m.color);
    switch (preview_kind(m)) {
        case Material::Kind::matte: finish = "diffuse 1 ambient 1"; break;
        case Material::Kind::plastic:
            finish = fmt::format("diffuse 1 ambient 1 {}", smooth ? "" : highlight(alpha, f0));
            break;
        case Material::Kind::metal:
            finish = fmt::format("diffuse 0 ambient 0 metallic {} reflection {{ 1 metallic }}",
                                 smooth ? "" : highlight(alpha, 1));
            break;
        case Material::Kind::mirror: finish = "diffuse 0 ambient 0 reflection { 1 metallic }"; break;
        case Material::Kind::glass:
            paint = fmt::format("pigment {{ rgbf <{}, {}, {}, 1> }}", m.color.a.x, m.color.a.y, m.color.a.z);
            finish = "diffuse 0 ambient 0 reflection { 0, 1 fresnel } conserve_energy";
            interior = fmt::format(" interior {{ ior {} }}", m.ior);
            break;
        case Material::Kind::pbr: break;  // preview_kind() returns one of the others
    }
    return fmt::format("material {{ texture {{ {} finish {{ {} }} }}{} }}\n", paint, finish, interior);
}

}  // namespace deburr
