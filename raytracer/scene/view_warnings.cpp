#include "raytracer/scene/view_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "bounds/decision_diagram.hpp"
#include "bounds/solid_tree.hpp"
#include "raytracer/scene/solid_survey.hpp"

namespace deburr {
namespace {

// Larger solids are not asked whether they contain a point.
constexpr double max_viewed_leaves = 20'000;

// In degrees: a smaller angle of view is taken to be meant in radians; a larger one shows mostly distortion.
constexpr double least_fov = pi, greatest_fov = 130;

bool is_black(Vec3 color) { return color == Vec3(0.0); }

std::string name_of(const Scene& scene, std::size_t solid) {
    return fmt::format("solid {}{}", solid + 1, scene.names[solid].empty() ? "" : " (" + scene.names[solid] + ")");
}

bool is_clear(const SolidTree& tree, const std::vector<Material>& materials) {
    return std::any_of(tree.leaves.begin(), tree.leaves.end(),
                       [&](const SolidLeaf& leaf) { return materials[leaf.material].kind == Material::Kind::glass; });
}

bool holds(const SolidTree& tree, Vec3 point) {
    try {
        return tree.contains(point);
    } catch (const TooEntangled&) {  // reported when it is rendered
        return false;
    }
}

// A point, and the warning if it is inside a solid.
struct Place {
    Vec3 point;
    std::string what;
};

std::vector<Place> places(const Scene& scene) {
    std::vector<Place> all{{scene.camera.eye, "the camera"}};
    for (std::size_t i = 0; i < scene.lights.size(); ++i)
        if (scene.lights[i].kind != Light::Kind::directional)
            all.push_back({scene.lights[i].position, fmt::format("light {}", i + 1)});
    return all;
}

// Whether the whole box is beyond one of the planes that bound the view.
bool out_of_view(const Box& box, const Camera& camera, double aspect) {
    const Vec3 view = glm::normalize(camera.target - camera.eye);
    const Vec3 right = glm::normalize(glm::cross(view, camera.up)), up = glm::cross(right, view);
    const double ty = std::tan(camera.fov * (pi / 360)), tx = ty * aspect;
    for (const Vec3 inward : {view, tx * view + right, tx * view - right, ty * view + up, ty * view - up}) {
        bool out = true;
        for (int i = 0; i < 8; ++i) {
            const Vec3 corner((i & 1 ? box.hi : box.lo).x, (i & 2 ? box.hi : box.lo).y, (i & 4 ? box.hi : box.lo).z);
            out &= glm::dot(inward, corner - camera.eye) < 0;
        }
        if (out) return true;
    }
    return false;
}

}  // namespace

bool is_unlit(const Scene& scene) {
    const bool shines = std::any_of(scene.lights.begin(), scene.lights.end(),
                                    [](const Light& light) { return light.power > 0 && !is_black(light.color); });
    const bool glows = std::any_of(scene.materials.begin(), scene.materials.end(),
                                   [](const Material& material) { return !is_black(material.emission); });
    const Background& b = scene.lighting();
    if (glows || b.by_day() || !b.file.empty()) return false;
    const bool black = b.sky ? is_black(b.horizon) && is_black(b.zenith) : is_black(b.color);
    return !shines && black && is_black(scene.ambient);
}

std::vector<std::string> view_warnings(const Scene& scene, double aspect) {
    std::vector<std::string> lines;
    const auto say = [&](const std::string& what) { lines.push_back(fmt::format("{}: {}", scene.file, what)); };
    if (is_unlit(scene)) say("there is no light: give lights, a background or ambient, or leave all of them out");

    const double fov = scene.camera.fov;
    if (fov <= least_fov)
        say(fmt::format("camera: the fov is {:.3g} degrees; if these are radians, write {:.3g}", fov,
                        fov * (180 / pi)));
    else if (fov >= greatest_fov)
        say(fmt::format("camera: a fov of {:.3g} degrees distorts; 20 to 60 are usual", fov));

    const std::vector<Place> all_places = places(scene);
    SolidSurvey survey;
    bool bounded = false, visible = false;
    for (std::size_t i = 0; i < scene.solids.size(); ++i) {
        const Solid& solid = scene.solids[i];
        const Box box = survey.at(solid).box;
        std::vector<const Place*> near;
        for (const Place& place : all_places)
            if (box.contains(place.point)) near.push_back(&place);
        if (!near.empty() && solid.node().leaves <= max_viewed_leaves) {
            const SolidTree tree = flatten(solid);
            if (!is_clear(tree, scene.materials))
                for (const Place* place : near)
                    if (holds(tree, place->point))
                        say(fmt::format("{} is inside {}, at ({:.4g}, {:.4g}, {:.4g})", place->what, name_of(scene, i),
                                        place->point.x, place->point.y, place->point.z));
        }
        if (box.empty() || !box.finite()) continue;
        bounded = true;
        visible |= !out_of_view(box, scene.camera, aspect);
    }
    if (bounded && !visible) say("the camera sees none of the bounded solids; --frame moves it to where it does");
    if (!bounded && scene.framing) say("no solid is bounded, so there is nothing to frame: give a camera");
    return lines;
}

}  // namespace deburr
