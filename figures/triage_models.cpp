// Triage, figures 17 to 21: the hole punch, the stapler and the CSG example as meshes.
#include "figures/figure.hpp"
#include "figures/scene_pictures.hpp"

namespace deburr {
namespace {

// The object without the ground: the first bounded solid, or all of them.
Scene object_of(const Scene& scene, bool only_first) {
    Scene object = bounded_part(scene);
    if (only_first) object.solids = {object.solids.at(0)};
    return object;
}

std::string count(const SceneMesh& mesh) {
    const Topology t = topology(mesh.mesh);
    return fmt::format("{} polygons, cut into {} triangles, {}", mesh.mesh.polygons, mesh.mesh.triangles.size(),
                       t.manifold() ? "a closed 2-manifold" : fmt::format("with {} open edges", t.open_edges));
}

const FigurePictureSettings whole{.width = 720, .height = 456, .spp = 96, .noise = 0.01};
const FigurePictureSettings detail{.width = 420, .height = 300, .spp = 96, .noise = 0.01};

// Adds pictures (a) and (b) of a scene.
void pair(FigureContext& context, const Scene& scene, const Mesh& lines, const FigurePictureSettings& size,
          const std::string& what) {
    context.picture(wire_picture(context, scene, lines, {.width = size.width, .height = size.height}), "(a) " + what);
    context.picture(gouraud_picture(context, scene, {}, size), "(b) " + what);
}

void hole_punch(FigureContext& context, const std::string& softness) {
    context.columns(2);
    const auto scene = [&](const char* closeup) {
        return context.scene("hole_punch.lua", {{"softness", softness}, {"closeup", closeup}});
    };
    const SceneMesh mesh = mesh_scene(object_of(scene("none"), false), {});
    pair(context, scene("none"), mesh.mesh, whole, softness == "0" ? "the unsmoothed hole punch" : "the hole punch");
    if (softness != "0")
        for (const auto& [view, name] :
             {std::pair{"punch", "the punch"}, {"hinge", "part of the hinge"}, {"pins", "metal pins"}})
            pair(context, scene(view), mesh.mesh, detail, name);
    context.measured(fmt::format("{}.", count(mesh)));
}

void stapler(FigureContext& context, const char* show) {
    context.columns(2);
    Scene scene = context.scene("staplers.lua", {{"show", show}});
    scene.camera = {.eye = {13, 10.5, 18}, .target = {0, 1.7, 0}, .up = {0, 1, 0}, .fov = 26};
    const SceneMesh mesh = mesh_scene(object_of(scene, true), {});
    pair(context, scene, mesh.mesh, whole, "the stapler");
    context.measured(fmt::format("{}.", count(mesh)));
}

// The number of triangles all of whose corners are within `reach` of x.
std::size_t triangles_near(const Mesh& mesh, Vec3 x, double reach) {
    std::size_t n = 0;
    for (const Triangle& t : mesh.triangles) {
        bool near = true;
        for (const int v : t.vertex)
            for (int k = 0; k < 3; ++k) near &= std::abs(mesh.positions[v][k] - x[k]) <= reach;
        n += near;
    }
    return n;
}

void csg_example(FigureContext& context) {
    context.columns(2);
    const Scene scene = context.scene("csg_examples.lua");
    const Scene objects = object_of(scene, false);
    const SceneMesh mesh = mesh_scene(objects, {});
    pair(context, scene, mesh.mesh, whole, "the six objects");
    // As in the scene: object i is in column (i − 1) mod 3 and row (i − 1) div 3.
    const auto corner_of = [](int i) {
        return Vec3(1.8 * ((i - 1) % 3 - 1) - 0.5, 0, 2.1 * ((i - 1) / 3 - 0.5) - 0.5);
    };
    pair(context, enlarged(scene, corner_of(3) + Vec3(0.5, 0.95, 0.5), 0.85), mesh.mesh, detail,
         "a clipped rounded box subtracted from a sharp cube");
    const Vec3 concave = corner_of(6) + Vec3(0.75, 1, 0.75);
    pair(context, enlarged(scene, concave, 0.5), mesh.mesh, detail, "a concave corner of three planes");
    const double r = std::stod(scene.parameters.at("r"));
    context.measured(fmt::format("{}. The concave corner takes {} triangles.", count(mesh),
                                 triangles_near(mesh.parts.at(5), concave, 1.0001 * r)));
}

const char* const wire_and_gouraud = "(a) as a wire frame with hidden lines removed, (b) Gouraud shaded.";

const RegisteredFigure figure_17{{
    .name = "triage-17",
    .title = "Figure 17: the unsmoothed hole punch",
    .shows = wire_and_gouraud,
    .claim = "A simple CSG object with polyhedral primitives; with radius 0 the result is its boundary representation "
             "(§6.1, §6.2).",
    .scenes = {"hole_punch.lua"},
    .seconds = 15,
    .make = [](FigureContext& context) { hole_punch(context, "0"); },
}};

const RegisteredFigure figure_18{{
    .name = "triage-18",
    .title = "Figure 18: the hole punch, smoothed, with the punch, the hinge and metal pins enlarged",
    .shows = wire_and_gouraud,
    .claim = "A few radii make it look much better. Most of the surface is large rectangles; a smoothed edge is two "
             "long ones, a corner 6 "
             "triangles. The pin has a sharp edge at its top; cylindrical parts are rectangles, their ends triangles "
             "(§6.1).",
    .scenes = {"hole_punch.lua"},
    .seconds = 40,
    .make = [](FigureContext& context) { hole_punch(context, "1"); },
}};

const RegisteredFigure figure_19{{
    .name = "triage-19",
    .title = "Figure 19: the unsmoothed stapler",
    .shows = wire_and_gouraud,
    .claim = "The model before smoothing (§6.1).",
    .scenes = {"staplers.lua"},
    .seconds = 15,
    .make = [](FigureContext& context) { stapler(context, "sharp"); },
}};

const RegisteredFigure figure_20{{
    .name = "triage-20",
    .title = "Figure 20: the stapler, polygonized with Triage Polygonization",
    .shows = wire_and_gouraud,
    .claim = "Wherever possible the method finds long triangles and rectangles; thin objects, as the side plates of "
             "the hinge, are no problem (§6.1).",
    .scenes = {"staplers.lua"},
    .seconds = 20,
    .make = [](FigureContext& context) { stapler(context, "rounded"); },
}};

const RegisteredFigure figure_21{{
    .name = "triage-21",
    .title = "Figure 21: the CSG example, polygonized with Triage Polygonization",
    .shows = wire_and_gouraud,
    .claim = "The bottom enlargement, a concave corner of three planes, takes only 26 triangles (§6.1).",
    .scenes = {"csg_examples.lua"},
    .seconds = 20,
    .make = csg_example,
}};

}  // namespace
}  // namespace deburr
