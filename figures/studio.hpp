// Pictures of meshes as in the papers: on white, from a camera that frames them, with flat or smooth shading, as a wire
// frame, or both.
#pragma once
#include "figures/figure_context.hpp"
#include "polygonizer/mesh/mesh.hpp"
#include "raytracer/mesh/wire_frame.hpp"

namespace deburr {

enum class Shading { none, flat, smooth };  // none: white like paper

/// The appearance of a mesh in a picture.
struct MeshAppearance {
    int width = 380, height = 380;
    Shading shading = Shading::smooth;
    bool lines = false;  // draw its edges
    EdgeChoice edges = EdgeChoice::polygons;
    WireMode mode = WireMode::visible;
    double line_width = 1.0;  // pixels
    Vec3 line_color{0.02, 0.02, 0.03};
    double gloss = 0.45;  // roughness of the plastic material; 1: matte
    int spp = 32;
};

/// A camera that looks at the box from `direction` (which points away from it), so near that the box fills the picture.
/// `fov` in degrees.
Camera framing(const Box& box, Vec3 direction, int width, int height, double fov = 22, Vec3 up = {0, 1, 0});

/// The bounding box of the mesh's vertices.
Box box_of(const Mesh& mesh);

/// A picture of the mesh. `colors` (linear) are indexed by the triangles' materials.
Film mesh_picture(const FigureContext& context, const Mesh& mesh, const std::vector<Vec3>& colors, const Camera& camera,
                  const MeshAppearance& appearance);

/// Linear colours of cell classes and of kinds of polygons.
namespace studio {
inline const Vec3 low{0.62, 0.70, 0.80}, high{0.80, 0.30, 0.16}, unclassified{0.85, 0.58, 0.10};
inline const Vec3 tree{0.16, 0.36, 0.62}, subspace{0.86, 0.52, 0.08}, plain{0.55, 0.60, 0.66};
}  // namespace studio

}  // namespace deburr
