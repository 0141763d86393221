#include "figures/studio.hpp"

#include "raytracer/mesh/mesh_tracer.hpp"

namespace deburr {
namespace {

// Radiance of the room from all around, and irradiance of the lamp behind the viewer's left shoulder.
constexpr double room = 0.42, lamp = 1.7;

Scene studio_scene(const std::vector<Vec3>& colors, const Camera& camera, double gloss) {
    Scene scene;
    scene.camera = camera;
    scene.background.color = Vec3(room);
    const Vec3 forward = glm::normalize(camera.target - camera.eye);
    const Vec3 right = glm::normalize(glm::cross(forward, camera.up));
    const Vec3 up = glm::cross(right, forward);
    Light light;
    light.kind = Light::Kind::directional;
    light.direction = glm::normalize(forward * 0.75 + right * 0.55 - up * 0.75);
    light.power = lamp;
    scene.lights.push_back(light);
    for (const Vec3& color : colors) {
        Material material;
        material.kind = gloss < 1 ? Material::Kind::plastic : Material::Kind::matte;
        material.color.a = color;
        material.roughness = gloss;
        scene.materials.push_back(material);
    }
    return scene;
}

}  // namespace

Box box_of(const Mesh& mesh) {
    Box box = Box{mesh.positions.at(0), mesh.positions.at(0)};
    for (const Vec3& x : mesh.positions) {
        box.lo = glm::min(box.lo, x);
        box.hi = glm::max(box.hi, x);
    }
    return box;
}

Camera framing(const Box& box, Vec3 direction, int width, int height, double fov, Vec3 up) {
    Camera camera;
    camera.target = 0.5 * (box.lo + box.hi);
    camera.up = up;
    camera.fov = fov;
    const Vec3 away = glm::normalize(direction);
    double distance = glm::length(box.hi - box.lo);
    // As near as the projections of the eight corners allow, with a margin; iterated, since perspective changes.
    for (int pass = 0; pass < 16; ++pass) {
        camera.eye = camera.target + distance * away;
        const ProjectiveCamera view(camera, width, height);
        Vec2 lo(1e9), hi(-1e9);
        for (int k = 0; k < 8; ++k) {
            const Vec2 p(
                view.project({k & 1 ? box.hi.x : box.lo.x, k & 2 ? box.hi.y : box.lo.y, k & 4 ? box.hi.z : box.lo.z}));
            lo = glm::min(lo, p);
            hi = glm::max(hi, p);
        }
        const Vec2 size = (hi - lo) / Vec2(width, height);
        constexpr double fill = 0.94;
        const double much = std::max(size.x, size.y) / fill;
        // Moves the middle of the projected box to the picture's.
        const Vec2 off = 0.5 * (lo + hi) - 0.5 * Vec2(width, height);
        const Vec3 right = glm::normalize(glm::cross(-away, camera.up)), above = glm::cross(right, -away);
        const double pixel = 2 * std::tan(fov * (pi / 360)) / height * distance;
        camera.target += right * (off.x * pixel) - above * (off.y * pixel);
        distance *= much;
    }
    camera.eye = camera.target + distance * away;
    return camera;
}

Film mesh_picture(const FigureContext& context, const Mesh& mesh, const std::vector<Vec3>& colors, const Camera& camera,
                  const MeshAppearance& appearance) {
    const int shrink = context.draft() ? 2 : 1;
    const int width = appearance.width / shrink, height = appearance.height / shrink;
    const MeshTracer tracer(appearance.shading == Shading::smooth ? mesh : flat_shaded(mesh));
    Film film;
    if (appearance.shading == Shading::none) {
        film = Film(width, height, {0, 0, width, height});
        for (Pixel& p : film.pixels) p.color = Vec3(1.0);
    } else {
        const Scene scene = studio_scene(colors, camera, appearance.gloss);
        film = context.render(scene, tracer,
                              {.width = appearance.width, .height = appearance.height, .spp = appearance.spp});
        // The room is dimmer than the paper, so the background is made white.
        for (Pixel& p : film.pixels) p.color += (1 - p.alpha) * (Vec3(1.0) - scene.background.color);
    }
    if (appearance.lines)
        draw_strokes(film,
                     wire_frame(mesh, mesh_edges(mesh, appearance.edges), tracer,
                                ProjectiveCamera(camera, width, height), film.window, appearance.mode),
                     appearance.line_color, appearance.line_width);
    return film;
}

}  // namespace deburr
