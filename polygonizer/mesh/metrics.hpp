// How far a mesh is from the solid it stands for.
//
// Among others the paper's three criteria [Vyatkin §4], each for a mesh of whichever method: deviation
// of vertices, deviation of normals, and uniformity. Distances are measured twice: to first order, |ρ − ½|/|∇ρ|, and by
// root search along the normal from the middle of every triangle. Units are the scene's.
#pragma once
#include "polygonizer/mesh/mesh.hpp"
#include "polygonizer/mesh/surface_distance.hpp"

namespace deburr {

struct Spread {
    double mean = 0, max = 0;
};

struct MeshMetrics {
    Topology topology;
    std::size_t polygons = 0;
    double area = 0, volume = 0;
    Box box;
    double vertex_distance = 0;  // largest, to first order
    double vertex_distance_mean = 0;
    Spread vertex_normal_degrees;  // between the triangles around a vertex, weighted by area, and the surface
    Spread first_order;            // at the middles of triangles
    Spread distance;               // there, by root search
    Spread normal_degrees;         // between triangle and surface, at their middles
    std::size_t inverted = 0;      // triangles that face inward there
    std::size_t degenerate = 0;    // triangles of no area
    double edge_mean = 0;
    double edge_spread = 0;  // standard deviation of edge lengths, in means
};

MeshMetrics measure(const Mesh& mesh, const SolidTree& solid);

/// Metrics of several meshes taken together.
MeshMetrics combined(const std::vector<MeshMetrics>& parts);

}  // namespace deburr
