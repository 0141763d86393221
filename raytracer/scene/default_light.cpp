#include "raytracer/scene/default_light.hpp"

namespace deburr {
namespace {

// Radiance of a white matte surface that faces both lamp and sky; light reflected between surfaces comes on top.
constexpr double brightest = 0.9;
// Least fraction of it that comes from the lamp, however bright the background is, so that surfaces have a lit side.
constexpr double least_of_lamp = 0.3;
// Ambient light in place of a black background.
constexpr double ambient = 0.2;

// The studio's background, which gives surfaces that look up a quarter of their light.
constexpr double horizon = 0.38, zenith = 0.18;

// Radiance that a white surface facing up gets from the sky, cosine-weighted: the mean of √y is ∫ √y 2y dy = 4/5.
double light_from_above(const Background& background) {
    constexpr double zenith_share = 0.8;
    const Vec3 color =
        background.sky ? glm::mix(background.horizon, background.zenith, zenith_share) : background.color;
    return max_component(color);
}

}  // namespace

void add_default_light(Scene& scene, bool has_background) {
    if (!has_background) {
        scene.background.sky = true;
        scene.background.horizon = Vec3(horizon);
        scene.background.zenith = Vec3(zenith);
    }
    const Background& lighting = scene.lighting();
    if (lighting.by_day() || !lighting.file.empty()) return;  // these contain their own main light
    double fill = light_from_above(lighting);
    if (fill == 0) {
        scene.ambient = Vec3(ambient);
        fill = ambient;
    }
    Light light;
    light.kind = Light::Kind::directional;
    light.power = pi * std::max(brightest - fill, least_of_lamp * brightest);
    scene.lights.push_back(light);
    scene.default_light = true;
}

void aim_default_light(Scene& scene) {
    const Camera& camera = scene.camera;
    const Vec3 view = glm::normalize(camera.target - camera.eye);
    const Vec3 right = glm::normalize(glm::cross(view, camera.up)), up = glm::cross(right, view);
    // From the front a box shows three tones: its top is the brightest, and its right side is lit by the sky only.
    scene.lights.front().direction = glm::normalize(view + 0.8 * right - 1.2 * up);
}

}  // namespace deburr
