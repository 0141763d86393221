// Vyatkin's figures 1 to 3, 8, 10, 11 and 14 to 16: free forms, and their octree meshes.
#include "bounds/bounding_box.hpp"
#include "figures/figure.hpp"
#include "figures/scene_pictures.hpp"
#include "polygonizer/octree/octree.hpp"
#include "raytracer/mesh/face_count.hpp"
#include "raytracer/mesh/mesh_tracer.hpp"

namespace deburr {
namespace {

double size_of(const Scene& scene) {
    Box box;
    for (const Solid& solid : bounded_part(scene).solids) box = hull(box, bounding_box(flatten(solid)));
    return largest(box.hi - box.lo);
}

// An octree mesh with at most this many triangles, as near to that as possible.
Mesh mesh_of(const Scene& scene, std::size_t triangles) {
    return mesh_scene_with_faces(bounded_part(scene), {.method = MeshMethod::octree}, triangles).mesh;
}

std::string count(const Mesh& mesh) {
    const Topology t = topology(mesh);
    return fmt::format("{} faces, {} vertices, {}", t.triangles, t.vertices,
                       t.manifold() ? "a closed 2-manifold" : fmt::format("{} open edges", t.open_edges));
}

Film shaded(const FigureContext& context, const Scene& scene, const Mesh& mesh, const FigurePictureSettings& size) {
    Scene ground = scene;
    ground.solids.clear();
    for (const Solid& solid : scene.solids)
        if (!bounding_box(flatten(solid)).finite()) ground.solids.push_back(solid);
    SceneMesh all = mesh_scene(ground, {.reach = rendering_reach});
    all.mesh.append(mesh, int(ground.solids.size()));
    return context.render(scene, MeshTracer(all.mesh, all.near), size);
}

// The visible vertices as dots.
Film cloud(const FigureContext& context, const Scene& scene, const Mesh& mesh, int width, int height) {
    const int shrink = context.draft() ? 2 : 1;
    width /= shrink, height /= shrink;
    Film film(width, height, {0, 0, width, height});
    for (Pixel& p : film.pixels) p.color = Vec3(1.0);
    const MeshTracer tracer(mesh);
    const ProjectiveCamera camera(scene.camera, width, height);
    std::vector<Vec3> normal(mesh.positions.size(), Vec3(0.0));
    for (const Triangle& t : mesh.triangles)
        for (const int v : t.vertex) normal[v] += mesh.area_vector(t);
    std::vector<Stroke> dots;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const Vec3 x = mesh.positions[v], eye = camera.eye();
        if (glm::dot(normal[v], eye - x) <= 0) continue;
        const Vec3 start =
            x + 1e-3 * glm::length(eye - x) * glm::normalize(glm::normalize(normal[v]) + glm::normalize(eye - x));
        TraceCounters unused;
        if (tracer.any_hit({start, glm::normalize(eye - start)}, glm::length(eye - start), unused)) continue;
        const Vec2 p(camera.project(x));
        dots.push_back({p, p});
    }
    draw_strokes(film, dots, Vec3(0.02, 0.09, 0.25), 2.2);
    return film;
}

void quadrics(FigureContext& context) {
    const Scene scene = context.scene("quadric.lua");
    context.picture(
        context.render(scene, {.width = 720, .height = 720 * scene.height / scene.width, .spp = 48, .noise = 0.006}));
    context.measured(fmt::format("{} solids, rendered exactly from their equations.", scene.solids.size()));
}

void free_form(FigureContext& context) {
    const Scene scene = context.scene("free_form.lua");
    context.columns(2);
    const FigurePictureSettings size{.width = 480, .height = 480 * scene.height / scene.width, .spp = 32};
    context.picture(context.render(context.scene("free_form.lua", {{"f", "0"}}), size), "the ellipsoid alone");
    context.picture(context.render(scene, size), "with three perturbations");
    context.measured("Both are traced exactly, from the function.");
}

void points(FigureContext& context) {
    const Scene scene = context.scene("free_form.lua");
    const Mesh mesh = mesh_of(scene, 30000);
    context.picture(cloud(context, scene, mesh, 600, 600 * scene.height / scene.width));
    context.measured(fmt::format("{} surface points.", mesh.positions.size()));
}

void grid(FigureContext& context) {
    const Scene scene = context.scene("free_form.lua");
    const Mesh mesh = mesh_of(scene, 9000);
    context.picture(wire_picture(
        context, scene, mesh,
        {.width = 600, .height = 600 * scene.height / scene.width, .edges = EdgeChoice::triangles, .line_width = 0.7}));
    context.measured(fmt::format("{}.", count(mesh)));
}

void cone(FigureContext& context, bool keep) {
    const Scene scene = context.scene("cone.lua");
    context.columns(2);
    const MeshSettings settings{.method = MeshMethod::octree,
                                .edge = size_of(scene) / 18,
                                .hard_angle = keep ? OctreeOptions{}.hard_angle : 180};
    const Mesh mesh = mesh_scene(bounded_part(scene), settings).mesh;
    const FigurePictureSettings size{.width = 480, .height = 480 * scene.height / scene.width, .spp = 24};
    context.picture(wire_picture(context, scene, mesh,
                                 {.width = size.width, .height = size.height, .edges = EdgeChoice::triangles}),
                    "the mesh");
    context.picture(shaded(context, scene, flat_shaded(mesh), size), "flat shaded");
    const SolidTree tree = flatten(bounded_part(scene).solids.at(0));
    const double exact = volume(octree(tree, polygonization_box(tree), {.edge = size_of(scene) / 200}));
    context.measured(
        fmt::format("{}; {:.2f} % of the volume is missing.", count(mesh), 100 * (1 - volume(mesh) / exact)));
}

void figurine(FigureContext& context) {
    const Scene scene = context.scene("figurine.lua");
    context.columns(2);
    const FigurePictureSettings size{
        .width = 400, .height = 400 * scene.height / scene.width, .spp = 48, .noise = 0.006};
    const Mesh mesh = mesh_of(scene, 136306);
    context.picture(context.render(scene, size), "figure 14: the function, traced exactly");
    context.picture(shaded(context, scene, mesh, size), "figure 15: its polygons");
    context.measured(fmt::format("{}.", count(mesh)));
}

void teapot(FigureContext& context) {
    const Scene scene = context.scene("teapot.lua");
    context.columns(2);
    const FigurePictureSettings size{
        .width = 480, .height = 480 * scene.height / scene.width, .spp = 48, .noise = 0.008};
    const Mesh mesh = mesh_of(scene, 317188);
    context.picture(shaded(context, scene, mesh, size), "the polygons");
    context.picture(
        wire_picture(context, scene, mesh_of(scene, 9000),
                     {.width = size.width, .height = size.height, .edges = EdgeChoice::triangles, .line_width = 0.7}),
        "a coarser grid of it");
    context.measured(fmt::format("{}.", count(mesh)));
}

const RegisteredFigure figure_1{
    {.name = "vyatkin-1",
     .title = "Figure 1: surfaces of second order",
     .shows =
         "From the left: a cone and a paraboloid, an ellipsoid, a cylinder, hyperboloids of one and of two sheets.",
     .claim = "A general function F(x, y, z) of second order is the base of free forms (§3.1).",
     .scenes = {"quadric.lua"},
     .seconds = 15,
     .make = quadrics}};
const RegisteredFigure figure_2{
    {.name = "vyatkin-2",
     .title = "Figure 2: a free form based on a quadric",
     .shows = "An ellipsoid, and the same with two bumps and a dent.",
     .claim = "The surfaces are smooth, and complex forms need few perturbation functions: three here (§3.1).",
     .scenes = {"free_form.lua"},
     .seconds = 15,
     .make = free_form}};
const RegisteredFigure figure_3{{.name = "vyatkin-3",
                                 .title = "Figure 3: the cloud of points",
                                 .shows = "The points of the octree's cells on the front of the free form.",
                                 .claim = "Subdivision of space down to the wanted resolution gives a cloud of points "
                                          "on the surface, without holes (§3.2).",
                                 .scenes = {"free_form.lua"},
                                 .make = points}};
const RegisteredFigure figure_8{
    {.name = "vyatkin-8",
     .title = "Figure 8: a grid of triangles",
     .shows = "The points linked, hidden lines removed.",
     .claim = "First a grid of quadrangles, then of triangles, in time linear in the number of points (§3.3).",
     .scenes = {"free_form.lua"},
     .make = grid}};
const RegisteredFigure figure_10{{.name = "vyatkin-10",
                                  .title = "Figure 10: a cone's mesh with artifacts",
                                  .shows = "Hard edges are treated like smooth surface (--hard-edges 180).",
                                  .claim = "At hard edges, of faces more than 45° apart, the form is lost (§3.4).",
                                  .scenes = {"cone.lua"},
                                  .seconds = 8,
                                  .make = [](FigureContext& context) { cone(context, false); }}};
const RegisteredFigure figure_11{{.name = "vyatkin-11",
                                  .title = "Figure 11: the cone's mesh without artifacts",
                                  .shows = "The same grid, with points on the hard edges.",
                                  .claim = "With partitioned hard edges the artifacts are gone (§3.4).",
                                  .scenes = {"cone.lua"},
                                  .seconds = 8,
                                  .make = [](FigureContext& context) { cone(context, true); }}};
const RegisteredFigure figure_14{
    {.name = "vyatkin-14",
     .title = "Figures 14 and 15: a function-based object, and as polygons",
     .shows = "An owl of one ellipsoid and 83 perturbation functions; the paper's model is not printed.",
     .claim = "83 perturbation functions; 136306 faces and 68418 vertices.",
     .scenes = {"figurine.lua"},
     .seconds = 40,
     .make = figurine}};
const RegisteredFigure figure_16{{.name = "vyatkin-16",
                                  .title = "Figure 16: a teapot",
                                  .shows = "",
                                  .claim = "13 perturbation functions; 317188 faces and 158613 vertices.",
                                  .scenes = {"teapot.lua"},
                                  .seconds = 40,
                                  .make = teapot}};

}  // namespace
}  // namespace deburr
