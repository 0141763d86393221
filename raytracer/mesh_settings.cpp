#include "raytracer/mesh_settings.hpp"

#include <fmt/format.h>

#include "raytracer/errors.hpp"
#include "raytracer/option_values.hpp"

namespace deburr {
namespace {

// As rendering_tolerance for free forms, which have no radius, in their sizes: a fifth of a pixel where they fill
// a picture of 1000.
constexpr double rendering_tolerance_in_sizes = 2e-4;

}  // namespace

MeshMethod parse_mesh_method(const std::string& what, const std::string& name) {
    if (name == "triage") return MeshMethod::triage;
    if (name == "marching-cubes") return MeshMethod::marching_cubes;
    if (name == "octree") return MeshMethod::octree;
    throw UsageError(fmt::format("{}: expected {}, got '{}'", what, mesh_method_names(), name));
}

std::string mesh_method_names() { return "triage, marching-cubes or octree"; }

std::string mesh_method_name(MeshMethod method) {
    return method == MeshMethod::triage ? "triage" : method == MeshMethod::octree ? "octree" : "marching-cubes";
}

double parse_tolerance(const std::string& text) {
    return text == "inf" ? infinity : parse_positive("--tolerance", text);
}

MeshSettings picture_mesh_settings(const std::string& via, const std::string& tolerance) {
    MeshSettings settings;
    if (!via.empty()) settings.method = parse_mesh_method("--via", via);
    settings.reach = rendering_reach;
    if (tolerance.empty()) {
        settings.tolerance_in_radii = rendering_tolerance;
        settings.tolerance_in_sizes = rendering_tolerance_in_sizes;
    } else
        settings.tolerance = parse_tolerance(tolerance);
    return settings;
}

}  // namespace deburr
