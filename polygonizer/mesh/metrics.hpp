// Measures how far a mesh is from its solid.
//
// Among the metrics are the paper's three criteria [Vyatkin §4], for meshes of any method: deviation of vertices,
// deviation of normals, and uniformity of edges. Distances are measured in two ways: to first order, |ρ − ½|/|∇ρ|, and
// by root search along the normal from the middle of every triangle. Lengths are the scene's, angles are in degrees.
#pragma once
#include "polygonizer/mesh/mesh.hpp"
#include "polygonizer/mesh/surface_distance.hpp"

namespace deburr {

/// Mean and maximum of a quantity.
struct Spread {
    double mean = 0, max = 0;
};

/// The metrics of a mesh.
struct MeshMetrics {
    Topology topology;
    std::size_t polygons = 0;
    double area = 0, volume = 0;
    Box box;
    double vertex_distance = 0;       // of vertices from the surface, to first order: the largest
    double vertex_distance_mean = 0;  // the mean of these
    Spread vertex_normal_degrees;     // angle of each vertex normal to the area-weighted mean of its triangles' normals
    Spread first_order;               // distance of triangles' middles from the surface, to first order
    Spread distance;                  // the same, by root search
    Spread normal_degrees;            // angle between triangle and surface, at triangles' middles
    std::size_t inverted = 0;         // triangles that face inward
    std::size_t degenerate = 0;       // triangles without area
    double edge_mean = 0;
    double edge_spread = 0;  // standard deviation of edge lengths, relative to edge_mean
};

/// Measures a closed mesh against the solid that it stands for.
MeshMetrics measure(const Mesh& mesh, const SolidTree& solid);

/// The metrics of several meshes taken together; means are weighted by numbers of triangles.
MeshMetrics combined(const std::vector<MeshMetrics>& parts);

}  // namespace deburr
