// Meshes as the papers show them: on white paper, from a camera that frames them, shaded flat or
// smooth, as a wire frame, or both.
#pragma once
#include "figures/figure_context.hpp"
#include "polygonizer/mesh/mesh.hpp"
#include "raytracer/mesh/wire_frame.hpp"

namespace deburr {

enum class Shading { none, flat, smooth };  // none: paper-white

struct MeshAppearance {
    int width = 380, height = 380;
    Shading shading = Shading::smooth;
    bool lines = false;
    EdgeChoice edges = EdgeChoice::polygons;
    WireMode mode = WireMode::visible;
    double line_width = 1.0;  // pixels
    Vec3 line_color{0.02, 0.02, 0.03};
    double gloss = 0.45;  // roughness of the plastic; 1: matte
    int spp = 32;
};

/// Looks from `direction` (away from the box) at the middle of the box, near enough that it fills the
/// picture.
Camera framing(const Box& box, Vec3 direction, int width, int height, double fov = 22, Vec3 up = {0, 1, 0});

Box box_of(const Mesh& mesh);

/// `colors`: by the triangles' material; linear.
Film mesh_picture(const FigureContext& context, const Mesh& mesh, const std::vector<Vec3>& colors, const Camera& camera,
                  const MeshAppearance& appearance);

/// Linear colours for classes of cells and kinds of polygons.
namespace studio {
inline const Vec3 low{0.62, 0.70, 0.80}, high{0.80, 0.30, 0.16}, unclassified{0.85, 0.58, 0.10};
inline const Vec3 tree{0.16, 0.36, 0.62}, subspace{0.86, 0.52, 0.08}, plain{0.55, 0.60, 0.66};
}  // namespace studio

}  // namespace deburr
