// Wire frames: the edges of a mesh's polygons as antialiased lines in a picture, with hidden lines or back faces
// removed [Triage, figures 4 (g) and 17 to 22].
//
// Whether a point of an edge is hidden is decided by a ray against the mesh, point by point along the line. So all
// edges, including outlines, are drawn in full width, and nothing flickers as with a depth buffer.
#pragma once
#include <vector>

#include "polygonizer/mesh/mesh.hpp"
#include "raytracer/image/film.hpp"
#include "raytracer/render/camera.hpp"

namespace deburr {

/// An edge of a mesh, by indices.
struct MeshEdge {
    int a, b;         // vertices
    int left, right;  // triangles on either side; right = −1 at an open edge
};

/// Which edges of a mesh are drawn.
enum class EdgeChoice {
    polygons,   // edges of polygons: not those between two triangles in one plane
    triangles,  // all edges
};

/// The edges of the mesh that `choice` asks for.
std::vector<MeshEdge> mesh_edges(const Mesh& mesh, EdgeChoice choice);

/// Which parts of edges are drawn.
enum class WireMode {
    visible,  // hidden lines removed
    front,    // all edges of polygons that face the camera, even where hidden
};

/// A straight line in a picture, in pixels (see ProjectiveCamera).
struct Stroke {
    Vec2 from, to;
};

/// The visible parts of edges in and around a window of the camera's picture. `hiding` traces the surfaces that hide
/// edges, among them the mesh.
std::vector<Stroke> wire_frame(const Mesh& mesh, const std::vector<MeshEdge>& edges, const RayTracer& hiding,
                               const ProjectiveCamera& camera, const Window& window, WireMode mode);

/// The visible parts of a polyline that lies on surfaces; normals[i] is the surface's normal at points[i]. A point is
/// visible if nothing hides it after it is lifted a little along its normal and towards the eye.
std::vector<Stroke> visible_line(const std::vector<Vec3>& points, const std::vector<Vec3>& normals,
                                 const RayTracer& hiding, const ProjectiveCamera& camera, const Window& window);

/// Draws strokes over the film, weighing each pixel by the share that the lines cover. `line_width` is in pixels,
/// `color` linear. With `alpha` lines also make pixels opaque; otherwise alpha stays that of the solids.
void draw_strokes(Film& film, const std::vector<Stroke>& strokes, Vec3 color, double line_width, bool alpha = false);

/// The mesh with the normal of its facet at each corner.
Mesh flat_shaded(Mesh mesh);

}  // namespace deburr
