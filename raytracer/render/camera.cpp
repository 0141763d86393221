#include "raytracer/render/camera.hpp"

#include <cmath>

namespace deburr {
namespace {

// If the sine of the angle between `up` and the view is below this, up is ignored: their cross product has lost half of
// its digits.
const double min_sine = std::sqrt(epsilon);

Vec3 unit_or(Vec3 v, Vec3 otherwise) {
    const double length = glm::length(v);
    return length > 0 && std::isfinite(length) ? v / length : otherwise;
}

// The direction to the right of a viewer who looks forward with `up` above; any perpendicular one if up is parallel.
Vec3 rightwards(Vec3 forward, Vec3 up) {
    const Vec3 right = glm::cross(forward, unit_or(up, {0, 1, 0}));
    const double sine = glm::length(right);
    if (sine > min_sine) return right / sine;
    const Vec3 other = std::abs(forward.z) < 0.5 ? Vec3(0, 0, -1) : Vec3(1, 0, 0);
    return glm::normalize(glm::cross(forward, other));
}

}  // namespace

ProjectiveCamera::ProjectiveCamera(const Camera& camera, int width, int height)
    : orthographic_(camera.orthographic),
      eye_(camera.eye),
      forward_(unit_or(camera.target - camera.eye, {0, 0, -1})),
      lens_radius_(camera.lens_radius) {
    const double distance = glm::length(camera.target - camera.eye);
    focus_ = camera.focus > 0 ? camera.focus : distance;
    const Vec3 right = rightwards(forward_, camera.up);
    const Vec3 up = glm::cross(right, forward_);
    double pixel = 2 * std::tan(camera.fov * (pi / 360)) / height;
    if (orthographic_) pixel *= distance;
    dx_ = right * pixel;
    dy_ = up * -pixel;
    corner_ = forward_ - 0.5 * (double(width) * dx_ + double(height) * dy_);
    if (camera.shift != Vec3(0.0)) corner_ += camera.shift.x * width * dx_ - camera.shift.y * height * dy_;
}

// Maps the unit square to the unit disc [Shirley & Chiu 1997].
static Vec2 disc(Vec2 u) {
    const Vec2 s = 2.0 * u - 1.0;
    if (s == Vec2(0.0)) return s;
    const bool wide = std::abs(s.x) > std::abs(s.y);
    const double r = wide ? s.x : s.y, quarter = pi / 4;
    const double phi = wide ? quarter * (s.y / s.x) : 2 * quarter - quarter * (s.x / s.y);
    return r * Vec2(std::cos(phi), std::sin(phi));
}

Ray ProjectiveCamera::ray(double x, double y, Vec2 u) const {
    const Vec3 on_picture = corner_ + x * dx_ + y * dy_;
    const Vec3 center = orthographic_ ? eye_ + (on_picture - forward_) : eye_;
    const Vec3 in_focus = center + focus_ * (orthographic_ ? forward_ : on_picture);
    const Vec2 at = lens_radius_ * disc(u);
    const Vec3 origin = center + at.x * glm::normalize(dx_) + at.y * glm::normalize(dy_);
    return {origin, glm::normalize(in_focus - origin)};
}

Vec3 ProjectiveCamera::project(Vec3 point) const {
    const Vec3 d = point - eye_;
    const double z = glm::dot(d, forward_);
    const Vec3 on_picture = orthographic_ ? d - z * forward_ + forward_ - corner_ : d / z - corner_;
    return {glm::dot(on_picture, dx_) / glm::dot(dx_, dx_), glm::dot(on_picture, dy_) / glm::dot(dy_, dy_), z};
}

Vec3 ProjectiveCamera::to_eye(Vec3 point) const {
    return orthographic_ ? -glm::dot(point - eye_, forward_) * forward_ : eye_ - point;
}

}  // namespace deburr
