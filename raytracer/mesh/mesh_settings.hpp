// Settings of meshing: the method, and how fine the mesh is.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "polygonizer/octree/octree.hpp"

namespace deburr {

/// How a solid is polygonized.
enum class MeshMethod { triage, marching_cubes, octree };

/// All methods as a list for messages.
std::string mesh_method_names();
std::string mesh_method_name(MeshMethod method);

/// MeshSettings::reach for pictures: the horizon of a floor that ends this far away is right to a pixel.
inline constexpr double rendering_reach = 1e4;

/// MeshSettings::tolerance_in_radii for pictures. On Figure 12 of Lobb's paper 99 % of the hits are then within 0.03 r
/// of the exact ones; the paper's single refinement of each edge leaves 0.26 r.
inline constexpr double rendering_tolerance = 0.03;

/// Tolerance of triage where none was given, in radii.
inline constexpr double default_tolerance_in_radii = 0.05;

/// Settings of meshing. Lengths are scene units unless a name says otherwise; a comment that begins
/// with methods applies to these only. Of several tolerances the least counts.
struct MeshSettings {
    /// Default: triage, or the octree for solids with free forms, which triage cannot follow.
    std::optional<MeshMethod> method = {};
    double tolerance = infinity;                     // triage, octree: distance from the surface
    double tolerance_in_radii = infinity;            // triage, octree: in each solid's least radius
    double triage_tolerance_in_radii = infinity;     // in radii, for triage and for models whose radius varies
    bool decimate = true;                            // thin these meshes out within their tolerance
    double tolerance_in_sizes = infinity;            // octree, for solids without a radius: in the solid's size
    double grid = 0;                                 // marching cubes: side of a cube; 0: half the least radius
    double edge = 0;                                 // octree: side of a cell; 0: chosen by the solid's size and radius
    int level = 0;                                   // octree: if not 0, 2^level cells along the solid's longest side
    double hard_angle = OctreeOptions{}.hard_angle;  // octree: see OctreeOptions
    double coarseness = 1;                           // factor of each solid's grid, edge or tolerance
    bool check = false;                              // check (mesh_check.hpp), and make a part that fails once more
    double reach = 8;                                // cut infinite solids off at this many sizes of the finite ones
    bool leave_out_unbounded = false;                // give infinite solids no mesh instead
    std::vector<std::size_t> only = {};              // indices of the solids to be meshed; empty: all
};

/// Settings for pictures of meshes: finer than the defaults, with floors that reach the horizon.
MeshSettings picture_mesh_settings();

}  // namespace deburr
