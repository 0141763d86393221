#include "figures/scene_pictures.hpp"

#include "bounds/bounding_box.hpp"
#include "raytracer/mesh/mesh_tracer.hpp"

namespace deburr {

Scene bounded_part(Scene scene) {
    std::vector<Solid> solids;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < scene.solids.size(); ++i) {
        if (!bounding_box(flatten(scene.solids[i])).finite()) continue;
        solids.push_back(scene.solids[i]);
        names.push_back(scene.names[i]);
    }
    scene.solids = std::move(solids);
    scene.names = std::move(names);
    return scene;
}

Film wire_picture(const FigureContext& context, const Scene& scene, const Mesh& mesh, const WirePicture& appearance) {
    const int shrink = context.draft() ? 2 : 1;
    const int width = (appearance.width ? appearance.width : scene.width) / shrink,
              height = (appearance.height ? appearance.height : scene.height) / shrink;
    Film film(width, height, {0, 0, width, height});
    for (Pixel& p : film.pixels) p.color = Vec3(1.0);
    const MeshTracer tracer(mesh);
    draw_strokes(film,
                 wire_frame(mesh, mesh_edges(mesh, appearance.edges), tracer,
                            ProjectiveCamera(scene.camera, width, height), film.window, appearance.mode),
                 Vec3(0.02), appearance.line_width);
    return film;
}

Film gouraud_picture(const FigureContext& context, const Scene& scene, MeshSettings settings,
                     const FigurePictureSettings& picture) {
    settings.reach = rendering_reach;
    const SceneMesh mesh = mesh_scene(scene, settings);
    return context.render(scene, MeshTracer(mesh.mesh, mesh.near), picture);
}

Scene enlarged(Scene scene, Vec3 target, double size) {
    scene.camera.target = target;
    scene.camera.fov = 2 * std::atan(0.5 * size / glm::length(target - scene.camera.eye)) * (180 / pi);
    return scene;
}

}  // namespace deburr
