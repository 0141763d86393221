// A scene's solids as meshes, by whichever method.
#pragma once
#include <string>
#include <vector>

#include "polygonizer/metrics.hpp"
#include "polygonizer/triage.hpp"
#include "raytracer/scene.hpp"

namespace deburr {

/// Triage leaves solids that hold free forms to the octree.
enum class MeshMethod { triage, marching_cubes };

/// Throws UsageError for a name that is none; `what` is for the message.
MeshMethod parse_mesh_method(const std::string& what, const std::string& name);
std::string mesh_method_names();
/// A number > 0, or UsageError.
double parse_positive(const std::string& what, const std::string& text);

struct MeshSettings {
    MeshMethod method = MeshMethod::triage;
    double tolerance = infinity;  // triage
    double tolerance_in_radii = infinity;  // triage: of each solid's least radius, if less
    double grid = 0;              // marching cubes; 0: half the least radius
    double reach = 8;             // infinite solids end this many sizes of the finite ones away
};

/// --tolerance: a number > 0, or inf for the paper's one refinement of each edge.
double parse_tolerance(const std::string& text);

/// For pictures of meshes, from --via and --tolerance (which may be empty): finer than a mesh that is
/// asked for, and with floors that reach the horizon.
MeshSettings picture_mesh_settings(const std::string& via, const std::string& tolerance);

/// The least radius > 0 in a solid; 0 if all is sharp.
double least_radius(const SolidTree& solid);

struct SceneMesh {
    Mesh mesh;                    // of all solids
    std::vector<Mesh> parts;      // solid by solid
    std::vector<SolidTree> trees;
    TriageStatistics triage;      // sums
    std::vector<std::string> warnings;
};

/// Solids that reach to infinity are cut off, at a distance that leaves the others in sight, and a
/// warning says so. Throws UnsupportedError if a grid would be too fine.
SceneMesh mesh_scene(const Scene& scene, const MeshSettings& settings);

std::vector<MeshMetrics> measure_parts(const SceneMesh& mesh);

}  // namespace deburr
