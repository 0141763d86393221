// A scene's mesh as the Triage paper shows it: (a) as a wire frame, (b) Gouraud shaded.
#pragma once
#include "figures/figure_context.hpp"
#include "raytracer/mesh/scene_mesh.hpp"
#include "raytracer/mesh/wire_frame.hpp"

namespace deburr {

/// The scene without solids that reach to infinity: a floor is no part of the object.
Scene bounded_part(Scene scene);

struct WirePicture {
    int width = 0, height = 0;  // 0: the scene's
    EdgeChoice edges = EdgeChoice::polygons;
    WireMode mode = WireMode::visible;
    double line_width = 0.9;
};

/// Black lines on white paper. `mesh` is that of a scene, or of some of its solids.
Film wire_picture(const FigureContext& context, const Scene& scene, const Mesh& mesh,
                  const WirePicture& appearance = {});

/// The whole scene's mesh, made with these settings, under the scene's own light.
Film gouraud_picture(const FigureContext& context, const Scene& scene, MeshSettings settings,
                     const FigurePictureSettings& picture);

/// The scene with its camera turned to `target` and the picture filled by about `size` there: for
/// enlargements.
Scene enlarged(Scene scene, Vec3 target, double size);

}  // namespace deburr
