// Triage §6.4: a robot that is smoothed with a larger and larger radius until it vanishes.
#include "figures/animation.hpp"
#include "figures/figure.hpp"
#include "polygonizer/triage/triage.hpp"
#include "raytracer/mesh/mesh_tracer.hpp"
#include "raytracer/mesh/scene_mesh.hpp"

namespace deburr {
namespace {

void make(FigureContext& context) {
    // The first radius, and its growth from frame to frame.
    constexpr double first = 0.02, factor = 1.15;
    constexpr int max_frames = 60;
    const FigurePictureSettings size{.width = 240, .height = 300, .spp = 16};
    std::vector<Film> frames;
    std::vector<double> radii;
    std::size_t triangles = 0, most = 0, open = 0;
    double vanished = 0;
    for (int i = 0; i < max_frames && vanished == 0; ++i) {
        const double r = first * std::pow(factor, i);
        const Scene scene = context.scene("melting_robot.lua", {{"r", fmt::format("{:.6f}", r)}});
        const SceneMesh mesh = mesh_scene(scene, {.reach = rendering_reach});
        const Mesh& robot = mesh.parts.at(1);
        open += !topology(robot).manifold();
        triangles += robot.triangles.size();
        most = std::max(most, robot.triangles.size());
        if (robot.triangles.empty()) vanished = r;
        frames.push_back(context.render(scene, MeshTracer(mesh.mesh, mesh.near), size));
        radii.push_back(r);
    }
    context.columns(4);
    context.picture_bytes(animated_png(frames, 0.12), frames.at(0).width,
                          fmt::format("animated: {} frames", frames.size()));
    // Seven frames, evenly from sharp to vanished.
    for (int k = 0; k < 7; ++k) {
        const std::size_t i = std::size_t(std::lround(k * double(frames.size() - 2) / 6));
        context.picture(frames[i], fmt::format("r = {:.2f}", radii[i]));
    }
    context.measured(
        fmt::format("{} radii from {:g} to {:.2f}: {} meshes, {} triangles in all and {} at most; {} of them closed "
                    "2-manifolds. {}",
                    radii.size(), radii.front(), radii.back(), radii.size(), triangles, most, radii.size() - open,
                    vanished > 0 ? fmt::format("The robot is gone at r = {:.2f}.", vanished)
                                 : std::string("The robot is still there.")));
}

const RegisteredFigure registered{{
    .name = "triage-robot",
    .title = "§6.4: a robot smoothed until it vanishes",
    .shows = "One sum of densities that touch, one radius, Gouraud-shaded meshes of Triage Polygonization.",
    .claim = "The paper's implementation aborts where it cannot generate a continuous surface, but managed an "
             "animation of a robot smoothed "
             "with a larger and larger filter until it vanishes completely.",
    .scenes = {"melting_robot.lua"},
    .seconds = 30,
    .make = make,
}};

}  // namespace
}  // namespace deburr
