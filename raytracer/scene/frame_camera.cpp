// With x to the right, y up and z towards the eye e, and t the tangents of half the angles of view, a point p is in
// the picture where |p.x − e.x| ≤ t.x (e.z − p.z), and so for y. So of the solids nothing matters but the four
// largest values of ±p.x + t.x p.z and ±p.y + t.y p.z, which are sides of the boxes of two linear images of them:
//     e.z = max over both axes of (right + left) / 2t,   e.x = (right − left) / 2,   e.y = (top − bottom) / 2
// leaves the same margin on opposite sides, and none on those that decide.
#include "raytracer/scene/frame_camera.hpp"

#include <numbers>

#include "bounds/bounding_box.hpp"
#include "raytracer/scene/default_light.hpp"
#include "raytracer/scene/solid_survey.hpp"

namespace deburr {
namespace {

// The part of the picture's width or height that the solids fill. Chosen.
constexpr double filled = 0.86;

// Boxes of linear images are found by laying a solid out anew; of a larger one the corners of its box do.
constexpr double max_laid_out = 20'000;

// `up` and a direction this nearly parallel leave no direction for the picture's side. Chosen.
constexpr double min_sine = 1e-3;

struct Axes {
    Vec3 right, up, back;
};

Axes axes_of(Vec3 from, Vec3 up) {
    Axes axes;
    axes.back = glm::normalize(from);
    Vec3 side = glm::cross(up, axes.back);
    // Straight from above the picture's upper edge is the far one.
    if (glm::length(side) < min_sine) side = Vec3(1, 0, 0);
    axes.right = glm::normalize(side - glm::dot(side, axes.back) * axes.back);
    axes.up = glm::cross(axes.back, axes.right);
    return axes;
}

Affine rows(Vec3 a, Vec3 b, Vec3 c) { return {glm::transpose(Mat3(a, b, c)), Vec3(0)}; }

}  // namespace

Vec3 up_axis(bool z_up) { return z_up ? Vec3(0, 0, 1) : Vec3(0, 1, 0); }

Framing default_framing(bool z_up) {
    Framing framing;
    if (z_up) framing.from = {3, -4, 2};
    return framing;
}

std::optional<Camera> framed_camera(const std::vector<Solid>& solids, const Framing& framing, Vec3 up, double aspect) {
    const Axes axes = axes_of(framing.from, up);
    const double ty = filled * std::tan(framing.fov * (std::numbers::pi / 360)), tx = ty * aspect;
    const Affine first = rows(axes.right + tx * axes.back, -axes.right + tx * axes.back, axes.up + ty * axes.back);
    const Affine second = rows(-axes.up + ty * axes.back, axes.right, axes.back);

    Box all;
    Vec3 firsts(-infinity), seconds(-infinity);  // upper sides
    const auto none_above = [](Vec3 side, Vec3 known) { return glm::all(glm::lessThanEqual(side, known)); };
    SolidSurvey survey;
    for (const Solid& solid : solids) {
        const Box box = survey.at(solid).box;
        if (box.empty() || !box.finite()) continue;
        all = hull(all, box);
        Vec3 in_first = image(first, box).hi, in_second = image(second, box).hi;
        // Most solids of a large scene lie between others.
        if (none_above(in_first, firsts) && none_above(in_second, seconds)) continue;
        if (solid.node().leaves <= max_laid_out) {
            in_first = glm::min(in_first, bounding_box(flatten(solid.transformed(first))).hi);
            in_second = glm::min(in_second, bounding_box(flatten(solid.transformed(second))).hi);
        }
        firsts = glm::max(firsts, in_first);
        seconds = glm::max(seconds, in_second);
    }
    if (all.empty()) return std::nullopt;

    const double right = firsts.x, left = firsts.y, top = firsts.z, bottom = seconds.x;
    const double z = std::max({(right + left) / (2 * tx), (top + bottom) / (2 * ty), seconds.z});
    const double depth = z - glm::dot(axes.back, 0.5 * (all.lo + all.hi));
    Camera camera;
    camera.fov = framing.fov;
    camera.up = axes.up;
    camera.eye = 0.5 * (right - left) * axes.right + 0.5 * (top - bottom) * axes.up + z * axes.back;
    camera.target = camera.eye - depth * axes.back;
    if (glm::dot(up, axes.up) > min_sine) camera.up = up;
    return camera;
}

bool frame_camera(Scene& scene, double aspect) {
    bool placed = true;
    if (scene.framing) {
        const auto camera = framed_camera(scene.solids, *scene.framing, up_axis(scene.z_up), aspect);
        placed = camera.has_value();
        if (camera) scene.camera = *camera;
    }
    if (scene.default_light) aim_default_light(scene);
    return placed;
}

}  // namespace deburr
