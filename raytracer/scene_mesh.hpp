// A scene's solids as meshes, by whichever method.
#pragma once
#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "polygonizer/metrics.hpp"
#include "polygonizer/octree.hpp"
#include "polygonizer/triage.hpp"
#include "raytracer/scene.hpp"

namespace deburr {

enum class MeshMethod { triage, marching_cubes, octree };

/// Throws UsageError for a name that is none; `what` is for the message.
MeshMethod parse_mesh_method(const std::string& what, const std::string& name);
std::string mesh_method_names();
std::string mesh_method_name(MeshMethod method);
/// A number > 0, or >= 0, or UsageError.
double parse_positive(const std::string& what, const std::string& text);
double parse_limit(const std::string& what, const std::string& text);

/// For pictures: the horizon of a floor that ends so many sizes away is the true one to a pixel.
inline constexpr double rendering_reach = 1e4;

struct MeshSettings {
    /// None: triage, and the octree for solids that hold what triage cannot follow, free forms.
    std::optional<MeshMethod> method = {};
    double tolerance = infinity;  // triage, octree
    double tolerance_in_radii = infinity;  // the same, of each solid's least radius, if less
    double tolerance_in_sizes = infinity;  // octree, without a radius: of each solid's size, if less
    double grid = 0;              // marching cubes; 0: half the least radius
    double edge = 0;              // octree: side of a cell; 0: by the solid's size and radius
    int level = 0;                // octree: 2^level cells along the solid's longest side, if not 0
    double hard_angle = OctreeOptions{}.hard_angle;  // octree
    double coarseness = 1;        // multiplies each solid's grid, edge or tolerance
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
    Box near;                     // of the finite solids: infinite ones are cut off far around it
    std::vector<SolidTree> trees;
    std::vector<MeshMethod> methods;  // that were used, each once
    TriageStatistics triage;      // sums
    OctreeStatistics octree;      // sums; the least edge, the highest level
    std::vector<std::string> warnings;

    std::string method_names() const;  // "octree, triage"
};

/// How the making of a mesh is watched.
struct MeshWatch {
    const std::atomic<bool>* stop = nullptr;  // once it is true, Stopped is thrown soon
    std::function<void(double)> done = {};    // the share of the work that is done since the last call; any thread
};

/// Solids are polygonized in parallel; the mesh does not depend on that. Those that reach to infinity are
/// cut off, at a distance that leaves the others in sight, and a warning says so. Throws UnsupportedError
/// if a grid would be too fine.
SceneMesh mesh_scene(const Scene& scene, const MeshSettings& settings, const MeshWatch& watch = {});

/// As near to `faces` triangles as the method comes, found by search over its coarseness; a warning
/// says so if that is not within 1 %.
SceneMesh mesh_scene(const Scene& scene, MeshSettings settings, std::size_t faces,
                     const std::atomic<bool>* stop = nullptr);

std::vector<MeshMetrics> measure_parts(const SceneMesh& mesh);

}  // namespace deburr
