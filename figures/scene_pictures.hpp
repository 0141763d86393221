// Pictures of a scene's mesh as in the Triage paper: (a) as a wire frame, (b) Gouraud shaded.
#pragma once
#include "figures/figure_context.hpp"
#include "raytracer/mesh/scene_mesh.hpp"
#include "raytracer/mesh/wire_frame.hpp"

namespace deburr {

/// The scene without unbounded solids, such as floors.
Scene bounded_part(Scene scene);

/// The appearance of a wire frame.
struct WirePicture {
    int width = 0, height = 0;  // 0: the scene's
    EdgeChoice edges = EdgeChoice::polygons;
    WireMode mode = WireMode::visible;
    double line_width = 0.9;  // pixels
};

/// Black lines on white. `mesh` is that of the scene or of some of its solids.
Film wire_picture(const FigureContext& context, const Scene& scene, const Mesh& mesh,
                  const WirePicture& appearance = {});

/// The mesh of the whole scene, made with these settings, under the scene's own light.
Film gouraud_picture(const FigureContext& context, const Scene& scene, MeshSettings settings,
                     const FigurePictureSettings& picture);

/// The scene with its camera turned to `target`, so that about `size` (a scene length) fills the picture.
Scene enlarged(Scene scene, Vec3 target, double size);

}  // namespace deburr
