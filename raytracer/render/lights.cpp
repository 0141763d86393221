#include "raytracer/render/lights.hpp"

#include <numbers>

namespace deburr {

using std::numbers::pi;

LightSource::LightSource(const Light& light)
    : kind_(light.kind),
      position_(light.position),
      direction_(0.0),
      u_(light.u),
      v_(light.v),
      emitted_(light.color * light.power) {
    switch (kind_) {
        case Light::Kind::point: emitted_ /= 4 * pi; break;
        case Light::Kind::directional: {
            const double length = glm::length(light.direction);
            if (length > 0) direction_ = light.direction / length;
            break;
        }
        case Light::Kind::area: {
            const Vec3 normal = glm::cross(u_, v_);
            area_ = glm::length(normal);
            samples_ = std::max(1, light.samples);
            if (area_ > 0) {
                direction_ = normal / area_;
                emitted_ /= pi * area_;
            }
            visible_ = light.visible && area_ > 0;
            break;
        }
        case Light::Kind::sphere: {
            samples_ = std::max(1, light.samples);
            radius_ = light.radius;
            area_ = 4 * pi * radius_ * radius_;
            if (area_ > 0) emitted_ /= pi * area_;
            visible_ = light.visible && area_ > 0;
            break;
        }
    }
}

Incident LightSource::at(Vec3 point, Vec2 u) const {
    Incident light;
    if (kind_ == Light::Kind::directional) {
        light.direction = -direction_;
        light.irradiance = emitted_;
        return light;
    }
    if (kind_ == Light::Kind::sphere) return at_sphere(point, u);
    Vec3 light_point = position_;
    if (kind_ == Light::Kind::area) light_point += (u.x - 0.5) * u_ + (u.y - 0.5) * v_;
    const Vec3 to_light = light_point - point;
    const double square = glm::dot(to_light, to_light);
    if (!(square > 0)) return light;
    light.distance = std::sqrt(square);
    const double inverse = 1 / light.distance;
    light.direction = to_light * inverse;
    if (kind_ == Light::Kind::point) {
        light.irradiance = emitted_ * (inverse * inverse);
        return light;
    }
    const double cosine = -glm::dot(direction_, light.direction);
    if (!(cosine > 0) || !(area_ > 0)) return light;
    light.density = square / (cosine * area_);
    light.irradiance = emitted_ / light.density;
    return light;
}

LightSource::Emission LightSource::seen(const Ray& ray, double t_max) const {
    if (kind_ == Light::Kind::sphere) return sphere_seen(ray, t_max);
    if (kind_ != Light::Kind::area || !(area_ > 0)) return {};
    const double cosine = -glm::dot(direction_, ray.direction);
    if (cosine == 0) return {};
    const double t = -glm::dot(position_ - ray.origin, direction_) / cosine;
    if (!(t > 0 && t < t_max)) return {};
    const Vec3 offset = ray.origin + t * ray.direction - position_;
    // Coordinates in the oblique frame (u, v) by Cramer's rule.
    const double a = glm::dot(glm::cross(offset, v_), direction_) / area_;
    const double b = glm::dot(glm::cross(u_, offset), direction_) / area_;
    if (std::abs(a) > 0.5 || std::abs(b) > 0.5) return {};
    if (cosine < 0) return {Vec3(0.0), 0.0, t};
    return {emitted_, t * t / (cosine * area_), t};
}

// 1 − cosine of the half angle of the cone around a sphere of radius `r` at a distance `d` > r: without cancellation
// for a far one.
double cone_depth(double r, double d) {
    const double s2 = r * r / (d * d);
    return s2 / (1 + std::sqrt(std::max(0.0, 1 - s2)));
}

double cone_density(double r, double d) { return 1 / (2 * pi * cone_depth(r, d)); }

Vec3 cone_direction(Vec3 to_center, double r, double d, Vec2 u) {
    const double depth = u.x * cone_depth(r, d), cosine = 1 - depth;
    const double sine = std::sqrt(std::max(0.0, depth * (1 + cosine))), phi = 2 * pi * u.y;
    const Vec3 z = to_center / d;
    const Vec3 other = std::abs(z.x) < 0.5 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    const Vec3 x = glm::normalize(glm::cross(z, other)), y = glm::cross(z, x);
    return sine * std::cos(phi) * x + sine * std::sin(phi) * y + cosine * z;
}

Incident LightSource::at_sphere(Vec3 point, Vec2 u) const {
    Incident light;
    const Vec3 to_center = position_ - point;
    const double d = glm::length(to_center);
    if (!(d > radius_) || !(area_ > 0) || !std::isfinite(d)) return light;
    light.direction = cone_direction(to_center, radius_, d, u);
    // The nearer crossing; at the cone's rim its root may be rounded below 0.
    const double b = glm::dot(to_center, light.direction);
    const double root2 = b * b - (d - radius_) * (d + radius_);
    light.distance = b - std::sqrt(std::max(0.0, root2));
    light.density = cone_density(radius_, d);
    light.irradiance = emitted_ / light.density;
    return light;
}

LightSource::Emission LightSource::sphere_seen(const Ray& ray, double t_max) const {
    const Vec3 to_center = position_ - ray.origin;
    const double b = glm::dot(to_center, ray.direction), d = glm::length(to_center);
    const double c = (d - radius_) * (d + radius_), root2 = b * b - c;
    if (!(root2 >= 0) || !(area_ > 0)) return {};
    const double root = std::sqrt(root2);
    if (d <= radius_) return b + root < t_max ? Emission{Vec3(0.0), 0.0, b + root} : Emission{};
    const double t = c / (b + root);  // b − root, which cancels for a far one
    if (!(b > 0 && t > 0 && t < t_max)) return {};
    return {emitted_, cone_density(radius_, d), t};
}

double LightSource::importance(Vec3 point) const {
    const double emitted = (emitted_.x + emitted_.y + emitted_.z) / 3;
    if (kind_ == Light::Kind::directional) return emitted;
    const Vec3 to_light = position_ - point;
    const double square = glm::dot(to_light, to_light);
    switch (kind_) {
        case Light::Kind::point: return square > 0 ? emitted / square : 0.0;
        case Light::Kind::sphere: return square > radius_ * radius_ ? emitted * pi * radius_ * radius_ / square : 0.0;
        default: break;
    }
    if (!(glm::dot(direction_, to_light) < 0)) return 0.0;  // the light is a plane one: all of it faces away
    return emitted * area_ / std::max(square, area_ / pi);
}

namespace {

// The sky's gradient is mix(horizon, zenith, √y). The cosine-weighted mean of √max(0, y) around a
// normal at height c, by a product rule in polar coordinates around the normal, equal areas of the
// projected disk: sin²θ and φ uniform.
double mean_zenith_share(double c) {
    constexpr int rings = 48, sectors = 48;
    static const auto cosines = [] {
        std::array<double, sectors> all;
        for (int j = 0; j < sectors; ++j) all[j] = std::cos(pi * (j + 0.5) / sectors);
        return all;
    }();
    const double s = std::sqrt(std::max(0.0, 1 - c * c));
    double sum = 0;
    for (int i = 0; i < rings; ++i) {
        const double sine2 = (i + 0.5) / rings;
        const double a = c * std::sqrt(1 - sine2), b = s * std::sqrt(sine2);
        for (const double cosine : cosines) sum += std::sqrt(std::max(0.0, a + b * cosine));
    }
    return sum / (rings * sectors);
}

}  // namespace

SkyLight::SkyLight(const Background& background) : background_(background) {
    const Vec3 none(0.0);
    black_ = background.sky ? background.horizon == none && background.zenith == none : background.color == none;
    if (!background.sky) return;
    for (int i = 0; i <= steps; ++i) zenith_share_[i] = mean_zenith_share(2.0 * i / steps - 1);
}

Vec3 SkyLight::mean(Vec3 normal) const {
    if (!background_.sky) return background_.color;
    const double at = glm::clamp(0.5 * (normal.y + 1), 0.0, 1.0) * steps;
    const auto i = at < steps ? std::size_t(at) : std::size_t(steps - 1);  // the last for no number, too
    const double share = glm::mix(zenith_share_[i], zenith_share_[i + 1], at - double(i));
    return glm::mix(background_.horizon, background_.zenith, share);
}

}  // namespace deburr
