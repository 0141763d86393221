#include "raytracer/mesh/mesh_settings.hpp"

namespace deburr {
namespace {

// The counterpart of rendering_tolerance for free forms, which have no radius; in their sizes: a fifth of a pixel where
// they fill a picture of 1000 pixels.
constexpr double rendering_tolerance_in_sizes = 2e-4;

}  // namespace

std::string mesh_method_names() { return "triage, marching-cubes or octree"; }

std::string mesh_method_name(MeshMethod method) {
    return method == MeshMethod::triage ? "triage" : method == MeshMethod::octree ? "octree" : "marching-cubes";
}

MeshSettings picture_mesh_settings() {
    MeshSettings settings;
    settings.reach = rendering_reach;
    settings.decimate = false;
    settings.tolerance_in_radii = rendering_tolerance;
    settings.tolerance_in_sizes = rendering_tolerance_in_sizes;
    return settings;
}

}  // namespace deburr
