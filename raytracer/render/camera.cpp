#include "raytracer/render/camera.hpp"

#include <cmath>
#include <numbers>

namespace deburr {
namespace {

// Below this sine of the angle between `up` and the view, up decides nothing: its cross product
// has lost half of its digits.
const double min_sine = std::sqrt(epsilon);

Vec3 unit_or(Vec3 v, Vec3 otherwise) {
    const double length = glm::length(v);
    return length > 0 && std::isfinite(length) ? v / length : otherwise;
}

// To the right of someone who looks forward with `up` above; any perpendicular where up fails.
Vec3 rightwards(Vec3 forward, Vec3 up) {
    const Vec3 right = glm::cross(forward, unit_or(up, {0, 1, 0}));
    const double sine = glm::length(right);
    if (sine > min_sine) return right / sine;
    const Vec3 other = std::abs(forward.z) < 0.5 ? Vec3(0, 0, -1) : Vec3(1, 0, 0);
    return glm::normalize(glm::cross(forward, other));
}

}  // namespace

PinholeCamera::PinholeCamera(const Camera& camera, int width, int height)
    : eye_(camera.eye), forward_(unit_or(camera.target - camera.eye, {0, 0, -1})) {
    const Vec3 right = rightwards(forward_, camera.up);
    const Vec3 up = glm::cross(right, forward_);
    const double pixel = 2 * std::tan(camera.fov * (std::numbers::pi / 360)) / height;
    dx_ = right * pixel;
    dy_ = up * -pixel;
    corner_ = forward_ - 0.5 * (double(width) * dx_ + double(height) * dy_);
}

Ray PinholeCamera::ray(double x, double y) const { return {eye_, glm::normalize(corner_ + x * dx_ + y * dy_)}; }

Vec3 PinholeCamera::project(Vec3 point) const {
    const Vec3 d = point - eye_;
    const double z = glm::dot(d, forward_);
    const Vec3 on_picture = d / z - corner_;
    return {glm::dot(on_picture, dx_) / glm::dot(dx_, dx_), glm::dot(on_picture, dy_) / glm::dot(dy_, dy_), z};
}

}  // namespace deburr
