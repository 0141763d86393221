#include "raytracer/scene/default_light.hpp"

#include <numbers>

namespace deburr {
namespace {

// What a white matte surface shows that faces both lamp and sky: light that surfaces throw on each other comes on top.
constexpr double brightest = 0.9;
// The least share of it that is the lamp's, however bright the background: or nothing would have a lit side.
constexpr double least_of_lamp = 0.3;
// Constant light in place of a background that is black.
constexpr double ambient = 0.2;

// The studio's background, which gives what looks up a quarter of its light.
constexpr double horizon = 0.38, zenith = 0.18;

// What a surface that looks up gets of the sky, weighted by the cosine: the mean of √y is ∫ √y 2y dy = 4/5.
double light_from_above(const Background& background) {
    constexpr double zenith_share = 0.8;
    const Vec3 color =
        background.sky ? glm::mix(background.horizon, background.zenith, zenith_share) : background.color;
    return std::max({color.x, color.y, color.z});
}

}  // namespace

void add_default_light(Scene& scene, bool has_background) {
    if (!has_background) {
        scene.background.sky = true;
        scene.background.horizon = Vec3(horizon);
        scene.background.zenith = Vec3(zenith);
    }
    const Background& lighting = scene.lighting();
    if (lighting.by_day() || !lighting.file.empty()) return;  // these have a lamp of their own
    double fill = light_from_above(lighting);
    if (fill == 0) {
        scene.ambient = Vec3(ambient);
        fill = ambient;
    }
    Light light;
    light.kind = Light::Kind::directional;
    light.power = std::numbers::pi * std::max(brightest - fill, least_of_lamp * brightest);
    scene.lights.push_back(light);
    scene.default_light = true;
}

void aim_default_light(Scene& scene) {
    const Camera& camera = scene.camera;
    const Vec3 view = glm::normalize(camera.target - camera.eye);
    const Vec3 right = glm::normalize(glm::cross(view, camera.up)), up = glm::cross(right, view);
    // From the front a box shows three tones: its top is the brightest, and the side to the right has the sky alone.
    scene.lights.front().direction = glm::normalize(view + 0.8 * right - 1.2 * up);
}

}  // namespace deburr
