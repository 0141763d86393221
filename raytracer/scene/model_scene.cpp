#include "raytracer/scene/model_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "raytracer/model/model_file.hpp"
#include "raytracer/scene/default_light.hpp"
#include "raytracer/scene/frame_camera.hpp"

namespace deburr {
namespace {

Material material_of(const ModelSettings& settings) {
    Material material;
    const auto kinds = {std::pair{"matte", Material::Kind::matte},
                        {"plastic", Material::Kind::plastic},
                        {"metal", Material::Kind::metal},
                        {"mirror", Material::Kind::mirror},
                        {"glass", Material::Kind::glass}};
    material.kind = Material::Kind::plastic;
    for (const auto& [name, kind] : kinds)
        if (settings.material == name) material.kind = kind;
    material.color.a = settings.color.value_or(Vec3(0.75, 0.45, 0.15));
    if (material.kind == Material::Kind::metal) material.color.a = settings.color.value_or(Vec3(0.9, 0.88, 0.85));
    if (material.kind == Material::Kind::glass || material.kind == Material::Kind::mirror)
        material.color.a = settings.color.value_or(Vec3(0.95));
    material.roughness = 0.45;
    return material;
}

}  // namespace

const std::vector<std::string>& model_materials() {
    static const std::vector<std::string> names = {"matte", "plastic", "metal", "mirror", "glass"};
    return names;
}

Scene model_scene(const std::string& path, const ModelSettings& settings) {
    const Model model = read_model(path);
    Scene scene;
    scene.file = path;
    scene.z_up = settings.z_up.value_or(model.format != "glb" && model.format != "gltf");
    for (const std::string& mended : model.mended) scene.notes.push_back(fmt::format("{}: {}", path, mended));
    scene.materials.emplace_back();
    scene.materials.push_back(material_of(settings));
    scene.solids.push_back(
        Solid::of_field(rounded_mesh(model.mesh, settings.round, settings.keep, scene.z_up)).material(1));
    scene.names.push_back(std::filesystem::path(path).stem().string());
    const Vec3 up = up_axis(scene.z_up);
    if (settings.ground) {
        Material ground;
        ground.color.a = Vec3(0.55);
        scene.materials.push_back(ground);
        const double floor = glm::dot(model.mesh->bounding_box().lo, up);
        scene.solids.push_back(Solid::sharp(Density::half_space(up, floor)).material(2));
        scene.names.push_back("ground");
    }
    scene.camera.up = up;
    scene.camera.eye = default_framing(scene.z_up).from;
    scene.framing = default_framing(scene.z_up);
    add_default_light(scene, false);
    return scene;
}

}  // namespace deburr
