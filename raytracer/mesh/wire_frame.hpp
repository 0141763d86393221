// Wire frames: the edges of a mesh's polygons as lines in a picture, antialiased, with hidden lines or
// back faces removed [Triage, figures 4 (g) and 17 to 22].
//
// Whether a point of an edge is hidden is asked of the mesh by a ray, point after point along the
// line; so edges, and outlines too, are drawn in their full width, and nothing flickers as it does
// where lines are compared with a depth buffer.
#pragma once
#include <vector>

#include "polygonizer/mesh/mesh.hpp"
#include "raytracer/image/film.hpp"
#include "raytracer/render/camera.hpp"

namespace deburr {

struct MeshEdge {
    int a, b;         // vertices
    int left, right;  // triangles on either side; right is -1 at an open edge
};

enum class EdgeChoice {
    polygons,   // of the polygons: not those between two triangles in one plane
    triangles,  // all
};

std::vector<MeshEdge> mesh_edges(const Mesh& mesh, EdgeChoice choice);

enum class WireMode {
    visible,  // hidden lines removed
    front,    // the edges of all polygons that face the camera, also of hidden ones
};

/// A straight line in a picture, in pixels as PinholeCamera has them.
struct Stroke {
    Vec2 from, to;
};

/// The visible parts of edges in and around a window of the camera's picture. `mesh` hides, and so does what else
/// `hiding` sees.
std::vector<Stroke> wire_frame(const Mesh& mesh, const std::vector<MeshEdge>& edges, const RayTracer& hiding,
                               const PinholeCamera& camera, const Window& window, WireMode mode);

/// The visible parts of a line through space that lies on surfaces; it is taken as visible where
/// nothing hides the same point lifted by `lift` along `normals`.
std::vector<Stroke> visible_line(const std::vector<Vec3>& points, const std::vector<Vec3>& normals,
                                 const RayTracer& hiding, const PinholeCamera& camera, const Window& window);

/// Draws over the film, each pixel by the share of it that the lines cover; `line_width` in pixels.
/// `alpha`: lines are opaque too; else alpha is of the solids alone.
void draw_strokes(Film& film, const std::vector<Stroke>& strokes, Vec3 color, double line_width, bool alpha = false);

/// The mesh with one normal for each facet.
Mesh flat_shaded(Mesh mesh);

}  // namespace deburr
