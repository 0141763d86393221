// Triage, figure 4: the steps of the method on a cube with a pit.
#include "bounds/bounding_box.hpp"
#include "figures/figure.hpp"
#include "figures/studio.hpp"
#include "polygonizer/mesh/metrics.hpp"
#include "polygonizer/triage/cell_mesh.hpp"
#include "polygonizer/triage/surface.hpp"
#include "polygonizer/triage/triage.hpp"

namespace deburr {
namespace {

// Index of the object among the scene's solids.
constexpr std::size_t pitted_cube = 4;

// The box around ρ > 0, which stands for the paper's bounding polyhedron of the outer planes.
Box support_of(const SolidTree& solid) {
    const DensityTree& density = solid.leaves.at(0).density;
    const int support = density.nodes.back().support;
    return support >= 0 ? density.supports[support] : bounding_box(solid);
}

Mesh cells_of(const Subdivision& s, const DensityTree& density, std::initializer_list<DensityClass> classes,
              double explode, std::size_t& count) {
    Mesh mesh;
    const Vec3 middle = cell_middle(s.complex, 0);
    count = 0;
    for (int cell = 0; cell < int(s.complex.cells.size()); ++cell) {
        const DensityClass c = cell_class(s, cell, 0, density);
        if (!std::count(classes.begin(), classes.end(), c)) continue;
        Mesh one = cell_mesh(s.complex, cell, 1, explode * (cell_middle(s.complex, cell) - middle));
        for (Triangle& t : one.triangles) t.material = c == DensityClass::one;
        mesh.append(one, 0);
        ++count;
    }
    return mesh;
}

// The triangles that lie on planes, or the others.
Mesh part_of(const Mesh& mesh, const std::vector<Origin>& origins, bool on_planes) {
    Mesh part = mesh;
    part.triangles.clear();
    for (std::size_t i = 0; i < origins.size(); ++i)
        if ((origins[i].cell < 0) == on_planes) part.triangles.push_back(mesh.triangles[i]);
    return part;
}

void make(FigureContext& context) {
    const Scene scene = context.scene("csg_examples.lua", {{"r", "0.1"}});
    const SolidTree solid = flatten(scene.solids.at(pitted_cube));
    const DensityTree& density = solid.leaves.at(0).density;
    Subdivision subdivision(solid, support_of(solid));

    const Camera camera = framing(bounding_box(solid), {0.55, 0.75, 1}, 380, 380);
    const Camera far = framing(inflated(support_of(solid), 0.12), {0.55, 0.75, 1}, 380, 380);
    MeshAppearance cells{.shading = Shading::flat, .lines = true, .gloss = 1};
    std::size_t low, high, unclassified;
    const Mesh low_cells = cells_of(subdivision, density, {DensityClass::low}, 0.3, low);
    const Mesh high_cells = cells_of(subdivision, density, {DensityClass::high, DensityClass::one}, 0.3, high);
    const Mesh open_cells = cells_of(subdivision, density, {DensityClass::unclassified}, 0.0, unclassified);
    context.columns(4);
    context.picture(mesh_picture(context, low_cells, {studio::low, studio::low}, far, cells), "(a) low cells");
    context.picture(mesh_picture(context, high_cells, {studio::high, studio::high}, far, cells), "(b) high cells");
    context.picture(mesh_picture(context, open_cells, {studio::unclassified, studio::unclassified}, camera, cells),
                    "(c) unclassified cells");

    Subspace subspace(subdivision);
    subspace.polygonize();
    std::vector<Origin> origins;
    const Mesh mesh = surface(subspace, solid, &origins);
    const Mesh tree = part_of(mesh, origins, true), curved = part_of(mesh, origins, false);
    const auto all = [](const Scene& s, Vec3 color) { return std::vector<Vec3>(s.materials.size(), color); };
    MeshAppearance appearance;
    appearance.shading = Shading::flat;
    appearance.lines = true;
    context.picture(mesh_picture(context, tree, all(scene, studio::tree), camera, appearance), "(d) tree polygons");
    context.picture(mesh_picture(context, curved, all(scene, studio::subspace), camera, appearance),
                    "(e) subspace polygons");
    appearance.lines = false;
    context.picture(mesh_picture(context, mesh, all(scene, studio::high), camera, appearance), "(f) flat shaded");
    appearance.shading = Shading::none;
    appearance.lines = true;
    appearance.mode = WireMode::front;
    context.picture(mesh_picture(context, mesh, all(scene, studio::high), camera, appearance), "(g) wire frame");
    appearance.shading = Shading::smooth;
    appearance.lines = false;
    context.picture(mesh_picture(context, mesh, all(scene, studio::high), camera, appearance), "(h) Gouraud shaded");
    context.measured(
        fmt::format("{} low, {} high and {} unclassified cells; {} triangles on planes, {} in unclassified cells.", low,
                    high, unclassified, tree.triangles.size(), curved.triangles.size()));
}

const RegisteredFigure registered{{
    .name = "triage-4",
    .title = "Figure 4: the three steps of Triage Polygonization",
    .shows = "A cube with a pit. The planes of its half-spaces and their parallels at ±r cut space into low (a), high "
             "(b) and unclassified cells (c). Between low and high cells lie the tree polygons (d), in unclassified "
             "cells the subspace "
             "polygons (e). Together they are the mesh (f) to (h).",
    .claim = "Unclassified cells are small; only in them an implicit surface must be polygonized (§4.1).",
    .scenes = {"csg_examples.lua"},
    .seconds = 8,
    .make = make,
}};

}  // namespace
}  // namespace deburr
