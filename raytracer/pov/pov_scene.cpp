#include "raytracer/pov/pov_scene.hpp"

#include <algorithm>

#include "bounds/bounding_box.hpp"
#include "raytracer/pov/pov_field.hpp"
#include "raytracer/pov/pov_materials.hpp"
#include "raytracer/pov/pov_text.hpp"

namespace deburr {
namespace {

// Infinite solids are cut off at this many times the extent of the finite solids, the eye and the target.
constexpr double reach = 20;

// Text that fits into a // comment: without line breaks or other control characters.
std::string in_one_line(std::string text) {
    for (char& c : text)
        if (static_cast<unsigned char>(c) < ' ') c = ' ';
    return text;
}

// The box at which infinite solids are cut off.
Box sight(const Scene& scene, const std::vector<SolidTree>& trees) {
    Box all = hull(Box{scene.camera.target, scene.camera.target}, Box{scene.camera.eye, scene.camera.eye});
    for (const SolidTree& tree : trees) {
        const Box box = bounding_box(tree);
        if (!box.empty() && box.finite()) all = hull(all, box);
    }
    const Vec3 size = all.hi - all.lo;
    return inflated(all, reach * max_component(size));
}

}  // namespace

PovScene pov_scene(const Scene& scene, Size size, PovSurface surface, bool radiosity) {
    PovScene out;
    std::vector<SolidTree> trees;
    for (const Solid& solid : scene.solids) trees.push_back(flatten(solid));
    surface.limit = sight(scene, trees);
    const auto material = [](int index) { return fmt::format("material {{ Material_{} }}", index); };

    std::string solids;
    for (std::size_t i = 0; i < trees.size(); ++i) {
        const PovSolid solid = pov_solid(trees[i], surface, material);
        if (solid.cut) out.warnings.push_back(fmt::format("solid {} is unbounded: it is cut off", i + 1));
        if (solid.text.empty()) continue;
        const std::string name = i < scene.names.size() ? scene.names[i] : "";
        solids += fmt::format("\n// Solid {}{}\n{}\n", i + 1,
                              name.empty() ? "" : fmt::format(": {}", in_one_line(name)), solid.text);
    }

    out.text =
        fmt::format("// {}, for POV-Ray 3.7, by Deburr " DEBURR_VERSION ": povray +W{} +H{} FILE\n#version 3.7;\n",
                    in_one_line(scene.file), size.width, size.height);
    out.text += pov_settings(scene, radiosity) + pov_camera(scene.camera, size) + pov_background(scene.background);
    for (const Light& light : scene.lights) out.text += pov_light(light, scene);
    out.text += "\n";
    if (!surface.sharp) out.text += pov_profile(!surface.min_max);
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        out.text += fmt::format("#declare Material_{} = {}", i, pov_material(scene.materials[i]));
    out.text += solids;
    return out;
}

}  // namespace deburr
