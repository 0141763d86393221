// How fine a mesh is to be, and by which method.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "polygonizer/octree/octree.hpp"

namespace deburr {

enum class MeshMethod { triage, marching_cubes, octree };

/// The methods in words, for messages.
std::string mesh_method_names();
std::string mesh_method_name(MeshMethod method);

/// Reach for pictures: the horizon of a floor that ends so many sizes away is the true one to a pixel.
inline constexpr double rendering_reach = 1e4;

/// Tolerance for pictures, in radii: on Figure 12 of Lobb's paper 99 % of the hits are then within 0.03 r of the exact
/// ones, where the paper's one refinement of each edge leaves 0.26 r.
inline constexpr double rendering_tolerance = 0.03;

/// Triage's tolerance where none was asked for, in radii.
inline constexpr double default_tolerance_in_radii = 0.05;

struct MeshSettings {
    /// Default: triage, but the octree for solids with free forms, which triage cannot follow.
    std::optional<MeshMethod> method = {};
    double tolerance = infinity;                     // triage, octree
    double tolerance_in_radii = infinity;            // the same, of each solid's least radius, if less
    double triage_tolerance_in_radii = infinity;     // the same, of triage, and of models whose radius varies
    bool decimate = true;                            // of these: thin meshes out within their tolerance
    double tolerance_in_sizes = infinity;            // octree, without a radius: of each solid's size, if less
    double grid = 0;                                 // marching cubes; 0: half the least radius
    double edge = 0;                                 // octree: side of a cell; 0: by the solid's size and radius
    int level = 0;                                   // octree: 2^level cells along the solid's longest side, if not 0
    double hard_angle = OctreeOptions{}.hard_angle;  // octree
    double coarseness = 1;                           // multiplies each solid's grid, edge or tolerance
    bool check = false;                              // what was made (mesh_check.hpp); what fails is made once more
    double reach = 8;                                // infinite solids end this many sizes of the finite ones away
    bool leave_out_unbounded = false;                // infinite solids have no mesh then
    std::vector<std::size_t> only = {};              // of the scene's solids, that have a mesh; empty: all
};

/// The settings for pictures of meshes: finer than a mesh that is asked for, with floors that reach the horizon.
MeshSettings picture_mesh_settings();

}  // namespace deburr
