#include "raytracer/render/bump.hpp"

#include "raytracer/render/textures.hpp"

namespace deburr {
namespace {

// Distance of the points whose difference is a pattern's slope, in its scale: a tenth of the finest noise of three
// octaves.
constexpr double pattern_step = 1.0 / 64;

// Least sine of the angle between the mirror direction and the surface.
constexpr double min_rise = 1e-3;

double step_of(const Texture& t) {
    if (t.kind == Texture::Kind::image) return t.data ? t.scale / t.data->width : t.scale;
    return t.scale * (t.kind == Texture::Kind::noise ? pattern_step / double(1 << (t.octaves - 1)) : pattern_step);
}

}  // namespace

Vec3 bumped_normal(const Texture& texture, double height, Vec3 position, Vec3 normal) {
    const Vec3 other = std::abs(normal.x) < 0.5 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    const Vec3 x = glm::normalize(glm::cross(normal, other)), y = glm::cross(normal, x);
    const double step = step_of(texture);
    const auto slope = [&](Vec3 along) {
        return (value_at(texture, position + 0.5 * step * along, normal) -
                value_at(texture, position - 0.5 * step * along, normal)) *
               (height / step);
    };
    return glm::normalize(normal - slope(x) * x - slope(y) * y);
}

Vec3 visible_bump(Vec3 bumped, Vec3 normal, Vec3 to_eye) {
    const double towards = glm::dot(bumped, to_eye);
    const Vec3 mirrored = 2 * towards * bumped - to_eye;
    const double rise = glm::dot(mirrored, normal), least = std::min(min_rise, glm::dot(to_eye, normal));
    if (towards > 0 && rise >= least) return bumped;
    return glm::normalize(to_eye + glm::normalize(mirrored + (least - rise) * normal));
}

Vec3 shading_normal(const Material& material, Vec3 position, Vec3 normal, Vec3 to_eye) {
    if (!material.bump) return normal;
    const Vec3 bumped = bumped_normal(*material.bump, material.bump_height, position, normal);
    const double side = glm::dot(normal, to_eye) < 0 ? -1.0 : 1.0;
    const Vec3 visible = side * visible_bump(side * bumped, side * normal, to_eye);
    return glm::length(visible) > 0.5 ? visible : normal;  // false for NaN, too
}

}  // namespace deburr
